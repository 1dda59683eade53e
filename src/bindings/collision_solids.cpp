// Solids of a few numbers, as Python has them, packed for the checks.
#include "library/collision_solids.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "collision.hpp"
#include "cspace/kinematics/pose_matrix.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::collision;

namespace {

using AnyTuple = nb::typed<nb::tuple, nb::any, nb::ellipsis>;

enum class Kind { box, sphere, capsule, cylinder, half_space, other };
constexpr std::size_t known_kinds = std::size_t(Kind::other);

// The classes of the kinds, in their order.
class KindTable {
  public:
    explicit KindTable(nb::tuple classes) : classes_(classes) {
        require(classes.size() == known_kinds, "there must be a class per kind");
        for (nb::handle each : classes) require(PyType_Check(each.ptr()), "the kinds must be classes");
    }
    Kind of(nb::handle shape) const {
        for (std::size_t k = 0; k < known_kinds; ++k)
            if (PyObject_TypeCheck(shape.ptr(), type_at(k))) return Kind(k);
        return Kind::other;
    }

  private:
    nb::tuple classes_;

    PyTypeObject* type_at(std::size_t k) const {
        return reinterpret_cast<PyTypeObject*>(PyTuple_GET_ITEM(classes_.ptr(), Py_ssize_t(k)));
    }
};

// The names of the fields of shapes, for fast look-ups.
struct FieldNames {
    nb::object pose = intern("pose"), size = intern("size"), radius = intern("radius"),
               length = intern("length"), normal = intern("normal"), offset = intern("offset");

    static nb::object intern(const char* name) { return nb::steal(PyUnicode_InternFromString(name)); }
};

// A field that holds n numbers.
template <std::size_t n>
std::array<double, n> numbers_in(nb::handle shape, const nb::object& field) {
    ConstDoubles given;
    require(given.read(nb::getattr(shape, field).ptr()) && given.size == npy_intp(n),
            "a field of a shape has another size");
    std::array<double, n> numbers;
    std::copy_n(given.data, n, numbers.begin());
    return numbers;
}
double number_in(nb::handle shape, const nb::object& field) {
    return nb::cast<double>(nb::getattr(shape, field));
}

using Rows = std::pair<Doubles, Plain<std::int64_t>>;
Rows arrays_of(const SolidRows& rows, npy_intp width) {
    const npy_intp n = npy_intp(rows.owners.size());
    Plain<std::int64_t> owners({n});
    std::copy(rows.owners.begin(), rows.owners.end(), owners.data);
    return {Doubles({n, width}, rows.numbers.data()), owners};
}

// Packs the shapes that are solids; the numbers of the others.
std::vector<int> add_solids(SolidPacker& packer, const AnyTuple& shapes, const AnyTuple& classes) {
    const KindTable kinds(classes);
    const FieldNames names;
    std::vector<int> others;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const nb::handle shape = PyTuple_GET_ITEM(shapes.ptr(), Py_ssize_t(i));
        const Kind kind = kinds.of(shape);
        if (kind == Kind::other) {
            others.push_back(int(i));
            continue;
        }
        const Posed T = kinematics::read_matrix(numbers_in<16>(shape, names.pose).data());
        const int owner = int(i);
        const auto radius = [&] { return number_in(shape, names.radius); };
        const auto length = [&] { return number_in(shape, names.length); };
        switch (kind) {
            case Kind::box:
                packer.add_box(owner, T, numbers_in<3>(shape, names.size).data());
                break;
            case Kind::sphere:
                packer.add_sphere(owner, T, radius());
                break;
            case Kind::capsule:
                packer.add_capsule(owner, T, radius(), length());
                break;
            case Kind::cylinder:
                packer.add_cylinder(owner, T, radius(), length());
                break;
            default:
                packer.add_half_space(owner, T, numbers_in<3>(shape, names.normal).data(),
                                      number_in(shape, names.offset));
        }
    }
    return others;
}

SolidPacker packer_in(const ConstDoubles& T_base_world) {
    require(T_base_world.ndim() == 2 && T_base_world.size == 16, "T_base_world must be an array (4, 4)");
    return SolidPacker(kinematics::read_matrix(T_base_world.data));
}

std::tuple<Rows, Rows, Rows, Rows, std::vector<int>> pack_solids(const AnyTuple& shapes,
                                                                 const AnyTuple& classes,
                                                                 const ConstDoubles& T_base_world) {
    SolidPacker packer = packer_in(T_base_world);
    std::vector<int> others = add_solids(packer, shapes, classes);
    return {arrays_of(packer.boxes, 15), arrays_of(packer.capsules, 7), arrays_of(packer.cylinders, 8),
            arrays_of(packer.half_spaces, 4), std::move(others)};
}

// Null if one of the shapes is no solid.
std::shared_ptr<SceneData> compile_solids(const AnyTuple& shapes, const AnyTuple& classes,
                                          const ConstDoubles& T_base_world) {
    SolidPacker packer = packer_in(T_base_world);
    return add_solids(packer, shapes, classes).empty() ? std::make_shared<SceneData>(packer.primitives())
                                                       : nullptr;
}

}  // namespace

void bind_collision_solids(nb::module_& m) {
    m.def("pack_solids", &pack_solids, "shapes"_a, "classes"_a, "T_base_world"_a,
          "Rows of boxes, of capsules, of cylinders and of half spaces, each with the numbers of their\n"
          "shapes, and the numbers of the shapes that are none of these. classes: box, sphere, capsule,\n"
          "cylinder and half space. T_base_world (4, 4).");
    m.def("compile_solids", &compile_solids, "shapes"_a, "classes"_a, "T_base_world"_a,
          "The scene of shapes that all are solids, as by pack_solids; None for others.");
}
