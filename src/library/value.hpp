// A number, a list or named parts: how the library hands a structure to a binding that turns it into plain
// objects.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cspace {

struct Value {
    enum class Kind { truth, integer, real, list, parts };
    Kind kind = Kind::parts;
    double number = 0;
    std::vector<Value> items;
    std::vector<std::string> names;  // of the items, where they are parts

    Value() = default;
    Value(bool x) : kind(Kind::truth), number(x) {}
    Value(int x) : kind(Kind::integer), number(x) {}
    Value(double x) : kind(Kind::real), number(x) {}
    Value(std::vector<Value> list) : kind(Kind::list), items(std::move(list)) {}

    Value& add(std::string name, Value part) {
        names.push_back(std::move(name));
        items.push_back(std::move(part));
        return *this;
    }
    Value& add(const Value& parts) {
        for (std::size_t k = 0; k < parts.items.size(); ++k) add(parts.names[k], parts.items[k]);
        return *this;
    }
};

}  // namespace cspace
