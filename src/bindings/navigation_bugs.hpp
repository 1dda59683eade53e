// What the entries of all robots without a map in a polygon world share: a question read, asked and answered
// with a route that carries evidence, or with the trace of the walk. A run is worth a few microseconds.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "cspace/navigation/bugs/contact_robot.hpp"
#include "maps_polygon_world.hpp"
#include "navigation_route.hpp"

// Bug says what one kind of them has of its own:
//   Answer                       its walk; .route, and .witness, where the goal is shut off
//   options, read(args)          how many options it takes; reads them, false with an error set
//   answer(core, start, goal)    the walk
//   trace(answer, goal)          its events
//   evidence(answer, walls)      the arguments of its evidence, a new tuple
template <class Bug>
class Walk {
  public:
    using Answer = typename Bug::Answer;

    // (world, planner, options, evidence, core, …, start, goal) → route, or None where an end needs a closer
    // look. evidence: what evidence is made with.
    static PyObject* route(PyObject*, PyObject* const* args, Py_ssize_t count) {
        Walk walk;
        if (!walk.read(args + 4, count - 4)) {
            if (PyErr_Occurred()) return nullptr;
            Py_RETURN_NONE;
        }
        const auto begin = std::chrono::steady_clock::now();
        const std::optional<Answer> answer = walk.ask();
        if (!answer) Py_RETURN_NONE;
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
        const double start[] = {walk.start_.x, walk.start_.y}, goal[] = {walk.goal_.x, walk.goal_.y};
        PyObject* made = make_route(args[0], args[1], args[2], start, goal, answer->route, spent.count());
        if (!made) return nullptr;
        PyObject* parts = Bug::evidence(*answer, *walk.core_->felt);
        PyObject* evidence = parts ? PyObject_CallObject(args[3], parts) : nullptr;
        Py_XDECREF(parts);
        reinterpret_cast<RouteObject*>(made)->evidence = evidence;
        if (!evidence) Py_CLEAR(made);
        return made;
    }

    // (core, …, start, goal) → the arrays of its trace
    static PyObject* trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
        Walk walk;
        std::optional<Answer> answer;
        if (walk.read(args, count)) answer = walk.ask();
        if (!answer && !PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "a trace takes a question with an answer");
        return answer ? trace_arrays(Bug::trace(*answer, walk.goal_)) : nullptr;
    }

  private:
    Bug bug_;
    PolygonCore* core_ = nullptr;
    cspace::Point start_, goal_;

    // False with an error set, or with start and goal that need a closer look.
    bool read(PyObject* const* args, Py_ssize_t count) {
        if (count != 3 + Bug::options)
            return PyErr_SetString(PyExc_TypeError, "too few arguments or too many"), false;
        core_ = polygon_core_of(args[0]);
        if (!core_) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), false;
        double ends[4];
        if (!bug_.read(args + 1)) return false;
        if (!read_point(args[1 + Bug::options], ends) || !read_point(args[2 + Bug::options], ends + 2))
            return false;
        start_ = {ends[0], ends[1]};
        goal_ = {ends[2], ends[3]};
        return true;
    }

    // Nothing where an end does not lie in free space.
    std::optional<Answer> ask() const {
        using namespace cspace;
        const maps::Settled from = core_->world.settle(start_, core_->tolerance);
        const maps::Settled to = core_->world.settle(goal_, core_->tolerance);
        if (!from.is_free() || !to.is_free()) return {};
        if (!core_->felt) core_->felt = std::make_unique<navigation::Walls>(core_->world.walls);
        Answer answer = bug_.answer(*core_, from.at, to.at);
        answer.route.path.front() = start_;
        if (answer.route.status == navigation::Status::found) answer.route.path.back() = goal_;
        return answer;
    }
};

template <class T>
PyObject* rows(const std::vector<T>& values, int columns, int type) {
    npy_intp shape[2] = {npy_intp(values.size()) / columns, columns};
    PyObject* array = PyArray_SimpleNew(columns == 1 ? 1 : 2, shape, type);
    if (!array) return nullptr;
    std::copy(values.begin(), values.end(),
              static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array))));
    return array;
}

// (ring, (x, y)) of where the line to the goal enters the walls that shut it off; None where none do.
template <class Answer>
PyObject* shut_of(const Answer& answer, const cspace::navigation::Walls& walls) {
    if (answer.route.status != cspace::navigation::Status::unreachable) return Py_NewRef(Py_None);
    const cspace::navigation::Touch& at = answer.witness;
    return Py_BuildValue("(i(dd))", walls.ring(at.in.name), at.at.x, at.at.y);
}

inline PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
