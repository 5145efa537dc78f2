// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"

#include <string>

// Any thread: values; their texts allocate.
namespace tactus
{

/// An object that a server shows to controllers.
struct ShownObject
{
    std::string name;    ///< Name, for users and for files of poses; valid.
    ContentHash model{}; ///< Hash of a model that the server has.
    Material material;
    Pose pose;

    bool operator==(const ShownObject&) const = default;
};

} // namespace tactus
