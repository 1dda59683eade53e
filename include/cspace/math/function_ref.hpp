// A reference to a function object, for a large function that calls one of its caller's: its code is then
// compiled once, not once per caller. It does not own what it refers to: a temporary serves one call.
#pragma once

#include <type_traits>

#include "cspace/math/isa.hpp"

namespace cspace::inline CSPACE_ISA {

template <class Signature>
class FunctionRef;

template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
  public:
    template <class Function, class = std::enable_if_t<!std::is_same_v<std::decay_t<Function>, FunctionRef>>>
    FunctionRef(Function&& function)
        : object_(const_cast<void*>(static_cast<const void*>(&function))),
          call_([](void* object, Arguments... arguments) -> Result {
              return (*static_cast<std::remove_reference_t<Function>*>(object))(arguments...);
          }) {}
    Result operator()(Arguments... arguments) const { return call_(object_, arguments...); }

  private:
    void* object_;
    Result (*call_)(void*, Arguments...);
};

}  // namespace cspace::inline CSPACE_ISA
