// Memory that a kernel works in, aligned to the widest packs.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace cspace {

struct FreeAligned {
    void operator()(void* memory) const { ::operator delete(memory, std::align_val_t(64)); }
};
using Scratch = std::unique_ptr<void, FreeAligned>;

inline Scratch make_scratch(std::size_t bytes) {
    return Scratch(::operator new(bytes, std::align_val_t(64)));
}
// The same, null where there is no memory.
inline Scratch try_scratch(std::size_t bytes) {
    return Scratch(::operator new(bytes, std::align_val_t(64), std::nothrow));
}

}  // namespace cspace
