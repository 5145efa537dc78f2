// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/dop18_tree.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace tactus::test
{

/// The trees that a typed test of the AB-Tree runs for, and how its instances are called.
using TreesOfAllVolumes = testing::Types<AbTree, Dop18Tree>;

struct VolumeNames
{
    template <typename Tree>
    static std::string GetName(int /*index*/) // The name that GoogleTest asks for.
    {
        return std::is_same_v<Tree, AbTree> ? "Aabb" : "Dop18";
    }
};

} // namespace tactus::test
