// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/c/tactus.h"

#include <algorithm>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// With the interpreter's lock: what the classes of the module have in common.
namespace tactus_python
{

namespace py = pybind11;

/// Exception for a fault of a call; tactus.Error in Python.
struct TactusError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// Calls a function of tactus.h; throws a TactusError with the line of a fault.
template <typename Call>
void check(Call&& call)
{
    tactus_error error{};
    switch (call(&error))
    {
    case TACTUS_DONE:
        return;
    case TACTUS_BAD_ARGUMENT:
        throw py::value_error(error.text);
    default:
        throw TactusError(error.text);
    }
}

/// Like check(), while other threads of Python run.
template <typename Call>
void check_unlocked(Call&& call)
{
    check(
        [&](tactus_error* error)
        {
            const py::gil_scoped_release others_may_run;
            return call(error);
        });
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::string shape_text(const py::array& array)
{
    return py::str(py::tuple(array.attr("shape")));
}

/// Floats or integers as doubles in C order.
inline Numbers numbers_of(const py::object& given, const char* name)
{
    const py::array array = py::array::ensure(given);
    const char kind = array ? array.dtype().kind() : '?';
    if (std::string_view("fiu").find(kind) == std::string_view::npos)
    {
        PyErr_Clear();
        const std::string type = array ? py::str(array.dtype()) : py::str(py::type::of(given));
        throw py::type_error(std::string(name) + ": " + type + "; an array of numbers is needed");
    }
    return Numbers::ensure(array);
}

inline void check_shape(const Numbers& array, const std::vector<py::ssize_t>& shape,
                        const char* name)
{
    const std::vector<py::ssize_t> is(array.shape(), array.shape() + array.ndim());
    if (is != shape)
    {
        throw py::value_error(std::string(name) + ": shape " + shape_text(array) + "; " +
                              std::string(py::str(py::tuple(py::cast(shape)))) + " is needed");
    }
}

inline void read_pose(tactus_pose& pose, const py::object& rotation,
                      const py::object& translation_m, double scale)
{
    pose.scale = scale;
    if (!rotation.is_none())
    {
        const Numbers rows = numbers_of(rotation, "rotation");
        check_shape(rows, {3, 3}, "rotation");
        std::copy_n(rows.data(), 9, pose.rotation);
    }
    if (!translation_m.is_none())
    {
        const Numbers place = numbers_of(translation_m, "translation_m");
        check_shape(place, {3}, "translation_m");
        std::copy_n(place.data(), 3, pose.translation_m);
    }
}

inline tactus_material material_of(double stiffness_n_per_m, double static_friction,
                                   const std::optional<double>& dynamic_friction,
                                   double damping_n_s_per_m, double viscosity_n_s_per_m,
                                   double texture_height_m, double texture_length_m)
{
    tactus_material material;
    tactus_material_default(&material);
    material.stiffness_n_per_m = stiffness_n_per_m;
    material.static_friction = static_friction;
    material.dynamic_friction = dynamic_friction.value_or(static_friction);
    material.damping_n_s_per_m = damping_n_s_per_m;
    material.viscosity_n_s_per_m = viscosity_n_s_per_m;
    material.texture_height_m = texture_height_m;
    material.texture_length_m = texture_length_m;
    return material;
}

/// Adds the class World and the function touch() to the module.
void add_world(py::module_& module);

} // namespace tactus_python
