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

/// Takes named values one after the other; a name ends in the value's frame and unit, as those of
/// the code do. Whoever tells of a frame doesn't know what becomes of it: columns, JSON or its
/// schema. One thread, not the haptic one: it allocates.
///
/// What is told of one kind of thing has the same names in the same order, whatever its values.
class FieldSink
{
public:
    FieldSink() = default;
    FieldSink(const FieldSink&) = delete;
    FieldSink& operator=(const FieldSink&) = delete;
    virtual ~FieldSink() = default;

    /// A number that is not finite may be told.
    virtual void number(const char* name, const std::optional<double>& value) = 0;
    virtual void integer(const char* name, const std::optional<std::int64_t>& value) = 0;
    virtual void flag(const char* name, bool value) = 0;
    virtual void text(const char* name, std::string_view value) = 0;
    /// A set of names.
    virtual void words(const char* name, const std::vector<std::string>& value) = 0;
    virtual void vector(const char* name, const std::optional<Vec3>& value) = 0;
    /// A rotation, as a unit quaternion: x, y, z, w.
    virtual void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) = 0;
};

} // namespace tactus
