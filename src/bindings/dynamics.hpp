// Dynamics as methods of a robot: one configuration is answered here and now, all else by cspace.dynamics.
#pragma once

#include "bindings.hpp"
#include "kinematics.hpp"

PyObject* compute_inverse_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames);
PyObject* compute_forward_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames);
PyObject* compute_mass_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
PyObject* compute_gravity_torques(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
PyObject* compute_coriolis_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
PyObject* compute_centroidal_momentum(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames);
PyObject* compute_momentum_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
PyObject* compute_kinetic_energy(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
PyObject* compute_potential_energy(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames);
PyObject* compute_inverse_derivatives(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames);
PyObject* compute_forward_derivatives(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames);
PyObject* compute_regressor(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);

extern const char inverse_dynamics_doc[], forward_dynamics_doc[], mass_matrix_doc[], gravity_torques_doc[],
    coriolis_matrix_doc[], centroidal_momentum_doc[], momentum_matrix_doc[], kinetic_energy_doc[],
    potential_energy_doc[], inverse_derivatives_doc[], forward_derivatives_doc[], regressor_doc[];
