// What the bindings of collision and planning share.
#pragma once

#include <optional>
#include <stdexcept>
#include <tuple>

#include "arrays_in_place.hpp"
#include "library/collision_checker.hpp"

inline void require(bool fits, const char* rule) {
    if (!fits) throw nanobind::value_error(rule);
}

// What touches: whether it is a link, the link, the object or other link.
using NamedContact = std::tuple<bool, int, int>;
inline std::optional<NamedContact> name_contact(const cspace::collision::Checker& checker,
                                                const cspace::collision::Contact& contact) {
    if (contact.other < 0) return std::nullopt;
    const int other = contact.is_pair ? contact.other : checker.scene_data().owner(contact.other);
    return NamedContact{contact.is_pair, contact.link, other};
}
