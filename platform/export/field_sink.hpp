// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Receives named values in order and writes them as columns, JSON or a JSON schema. A name ends in
/// the value's frame and unit, like the names of the code. One thread, not the haptic one: it
/// allocates.
///
/// Objects of one kind must add the same names in the same order, for all values.
class FieldSink
{
public:
    FieldSink() = default;
    FieldSink(const FieldSink&) = delete;
    FieldSink& operator=(const FieldSink&) = delete;
    virtual ~FieldSink() = default;

    /// Adds a number, which may be non-finite; none: unknown.
    virtual void number(const char* name, const std::optional<double>& value) = 0;
    virtual void integer(const char* name, const std::optional<std::int64_t>& value) = 0;
    virtual void flag(const char* name, bool value) = 0;
    virtual void text(const char* name, std::string_view value) = 0;
    /// Adds a set of names.
    virtual void words(const char* name, const std::vector<std::string>& value) = 0;
    virtual void vector(const char* name, const std::optional<Vec3>& value) = 0;
    /// Adds a rotation, as a unit quaternion: x, y, z, w.
    virtual void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) = 0;
};

} // namespace tactus
