#pragma once
#include <nanobind/nanobind.h>

void bind_math(nanobind::module_& m);
