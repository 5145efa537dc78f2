// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/world/world.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

/// A World with a cube of 100 mm round the origin, as a mesh in memory.
namespace tactus::test
{

inline constexpr double kTop_m = 0.05;     ///< Height of the cube's upper face.
inline constexpr double kRadius_m = 0.005; ///< Radius of the sphere that touches it.
inline constexpr double kPress_m = 0.0005; ///< Depth of the goal below the touching height.

inline WorldModel cube(MeshOptions options = {.unit = "mm", .name = "cube"})
{
    std::vector<std::array<double, 3>> vertices;
    for (int i = 0; i < 8; ++i)
    {
        vertices.push_back({(i & 1) != 0 ? 50.0 : -50.0, (i & 2) != 0 ? 50.0 : -50.0,
                            (i & 4) != 0 ? 50.0 : -50.0});
    }
    return mesh(std::move(vertices),
                {{0, 2, 1},
                 {1, 2, 3},
                 {4, 5, 6},
                 {5, 7, 6},
                 {0, 1, 4},
                 {1, 5, 4},
                 {2, 6, 3},
                 {3, 6, 7},
                 {0, 4, 2},
                 {2, 4, 6},
                 {1, 3, 5},
                 {3, 7, 5}},
                std::move(options));
}

inline HandPose above(double height_m)
{
    return {{0.01, 0.02, kTop_m + height_m}};
}

/// Moves the hand from 20 mm above the cube to a height above its face, and rests there.
inline HandState press(const Hand& hand, double height_m, int frames = 600)
{
    HandState state;
    for (int i = 1; i <= frames; ++i)
    {
        const double share = std::min(1.0, i / (0.75 * frames));
        const auto felt = hand.step(above(0.02 + share * (height_m - 0.02)));
        EXPECT_TRUE(felt) << felt.error().text;
        state = felt ? felt.value() : state;
    }
    return state;
}

/// Holds the hand at a place for some frames.
inline HandState hold(const Hand& hand, const HandPose& place, int frames)
{
    HandState state;
    for (int i = 0; i < frames; ++i)
    {
        state = hand.step(place).value();
    }
    return state;
}

/// Text of a refusal; empty if the call was not refused.
template <typename Value>
std::string line_of(const Result<Value, Refusal>& result)
{
    return result ? std::string() : result.error().text;
}

} // namespace tactus::test
