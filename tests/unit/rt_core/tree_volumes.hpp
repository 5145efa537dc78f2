// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/dop18_tree.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace tactus::test
{

/// Trees of a typed test, with the names of its instances.
using TreesOfAllVolumes = testing::Types<AbTree, Dop18Tree>;

struct VolumeNames
{
    template <typename Tree>
    static std::string GetName(int /*index*/) // Name required by GoogleTest.
    {
        return std::is_same_v<Tree, AbTree> ? "Aabb" : "Dop18";
    }
};

} // namespace tactus::test
