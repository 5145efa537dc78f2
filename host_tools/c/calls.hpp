// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/c/tactus.h"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/object_pose.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <utility>

// Any thread: what the calls of tactus.h have in common. Refusals are exceptions within a call.
namespace tactus::c_calls
{

// Ranges of the calls. They are wider than those of hrtc's options, which a device and a user
// limit: a caller of C may simulate any tool.

/// Least stiffness in N/m, and least limit of a force in N.
inline constexpr double kSmallestValue = 1e-3;
/// Least speed limit in m/s.
inline constexpr double kSlowest_m_per_s = 1e-6;
/// Largest stiffness, force, torque and speed, each in its SI unit.
inline constexpr double kLargestValue = 1e6;

/// Exception for a fault; the call returns `result` and writes `text`.
struct Fault
{
    tactus_result result;
    std::string text;
};

inline void tell(tactus_error* error, const std::string& text) noexcept
{
    if (error != nullptr)
    {
        const std::size_t length = std::min(text.size(), sizeof(error->text) - 1);
        std::memcpy(error->text, text.data(), length);
        error->text[length] = '\0';
    }
}

/// Executes a call; converts every exception to a result.
template <typename Work>
tactus_result guarded(tactus_error* error, Work&& work) noexcept
{
    try
    {
        work();
        if (error != nullptr)
        {
            error->text[0] = '\0';
        }
        return TACTUS_DONE;
    }
    catch (const Fault& fault)
    {
        tell(error, fault.text);
        return fault.result;
    }
    catch (const std::bad_alloc&)
    {
        tell(error, "out of memory");
    }
    catch (const std::exception& exception)
    {
        tell(error, exception.what());
    }
    return TACTUS_REFUSED;
}

template <typename... Arguments>
[[noreturn]] void refuse(tactus_result result, fmt::format_string<Arguments...> format,
                         Arguments&&... arguments)
{
    throw Fault{result, fmt::format(format, std::forward<Arguments>(arguments)...)};
}

template <typename T>
const T& given(const T* pointer, const char* name)
{
    if (pointer == nullptr)
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}: null pointer", name);
    }
    return *pointer;
}

template <typename T>
T& given(T* pointer, const char* name)
{
    return const_cast<T&>(given(static_cast<const T*>(pointer), name));
}

template <typename Record>
void check_size(const Record& record, const char* name)
{
    if (record.size != sizeof(Record))
    {
        refuse(TACTUS_BAD_VERSION,
               "{}: size is {}, this library needs {}; compile with the tactus.h of this version, "
               "and set size (the _default functions do)",
               name, record.size, sizeof(Record));
    }
}

inline void check_abi(std::uint32_t abi)
{
    if (abi != TACTUS_ABI)
    {
        refuse(TACTUS_BAD_VERSION,
               "the program was compiled for ABI version {}; this library has {}", abi, TACTUS_ABI);
    }
}

inline void check_range(double value, double low, double high, const std::string& name)
{
    if (!(value >= low && value <= high)) // Also refuses NaN.
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}: {}; {} to {} is allowed", name, value, low, high);
    }
}

/// Refuses an array with a number that is not finite.
inline void check_finite(const double* values, std::size_t count, const char* name)
{
    const double* end = values + count;
    const double* bad = std::find_if_not(values, end, [](double v) { return std::isfinite(v); });
    if (bad != end)
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}: element {} is {}; numbers must be finite", name,
               bad - values, *bad);
    }
}

inline void check_positions(const double* values_m, std::size_t count, const char* name)
{
    for (std::size_t i = 0; i < 3 * count; ++i)
    {
        if (!(std::abs(values_m[i]) < kGoalRange_m)) // Also refuses NaN.
        {
            refuse(TACTUS_BAD_ARGUMENT, "{}: element {} is {}; its magnitude must be below {} m",
                   name, i, values_m[i], kGoalRange_m);
        }
    }
}

inline Vec3 to_vec(const double* values)
{
    return {values[0], values[1], values[2]};
}

inline Mat3 to_rotation(const double* rows)
{
    Mat3 rotation;
    rotation << rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8];
    return rotation;
}

inline void write(double* to, std::size_t index, const Vec3& value)
{
    if (to != nullptr)
    {
        std::copy_n(value.data(), 3, to + 3 * index);
    }
}

template <typename T>
void write(T* to, std::size_t index, T value)
{
    if (to != nullptr)
    {
        to[index] = value;
    }
}

inline ObjectPose pose_of(const tactus_pose& pose, const std::string& name)
{
    check_finite(pose.rotation, 9, (name + "rotation").c_str());
    for (const double coordinate_m : pose.translation_m)
    {
        check_range(coordinate_m, -kPoseReachMax_m, kPoseReachMax_m, name + "translation_m");
    }
    check_range(pose.scale, kPoseScaleMin, kPoseScaleMax, name + "scale");
    ObjectPose place;
    place.rotation = to_rotation(pose.rotation);
    if (!is_rotation(place.rotation, kRotationTolerance))
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}rotation: not a rotation within {}", name,
               kRotationTolerance);
    }
    place.rotation = orthonormalised(place.rotation);
    place.translation_m = to_vec(pose.translation_m);
    place.scale = pose.scale;
    return place;
}

inline Material material_of(const tactus_material& from)
{
    check_size(from, "material");
    Material material;
    if (from.stiffness_n_per_m != 0.0)
    {
        check_range(from.stiffness_n_per_m, kSmallestValue, kLargestValue,
                    "material.stiffness_n_per_m");
        material.stiffness_n_per_m = from.stiffness_n_per_m;
    }
    check_range(from.static_friction, 0.0, kRoughest, "material.static_friction");
    check_range(from.dynamic_friction, 0.0, from.static_friction, "material.dynamic_friction");
    check_range(from.damping_n_s_per_m, 0.0, kMostDamped_n_s_per_m, "material.damping_n_s_per_m");
    check_range(from.viscosity_n_s_per_m, 0.0, kMostDamped_n_s_per_m,
                "material.viscosity_n_s_per_m");
    check_range(from.texture_length_m, from.texture_height_m > 0.0 ? kTextureLengthMin_m : 0.0,
                kTextureLengthMax_m, "material.texture_length_m");
    check_range(from.texture_height_m, 0.0, kTextureSteepest * from.texture_length_m,
                "material.texture_height_m");
    material.static_friction = from.static_friction;
    material.dynamic_friction = from.dynamic_friction;
    material.damping_n_s_per_m = from.damping_n_s_per_m;
    material.viscosity_n_s_per_m = from.viscosity_n_s_per_m;
    material.texture_height_m = from.texture_height_m;
    material.texture_length_m = from.texture_length_m;
    return material;
}

} // namespace tactus::c_calls
