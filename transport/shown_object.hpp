// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

#include <string>

// Any thread: these are values; their strings allocate.
namespace tactus
{

/// An object that a server shows to controllers.
struct ShownObject
{
    std::string name;    ///< Valid name, for users and pose files.
    ContentHash model{}; ///< Hash of a model that the server has.
    Material material;
    Pose pose;

    bool operator==(const ShownObject&) const = default;
};

} // namespace tactus
