// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/surface_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kSamples = 20'000;

/// A rectangle of two faces, x from 0 to `width` and y from 0 to 1, at height z.
TriangleMesh make_rectangle(double width, double z)
{
    return {{{0, 0, z}, {width, 0, z}, {width, 1, z}, {0, 1, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(SurfaceReference, parallel_surfaces_lie_their_distance_apart)
{
    const SurfaceReference reference(make_rectangle(1.0, 0.0), kSamples);

    const SurfaceError error = reference.error_of(make_rectangle(1.0, 0.25));

    EXPECT_NEAR(error.rms, 0.25, 1e-12);
    EXPECT_NEAR(error.max, 0.25, 1e-12);
}

/// Half of the larger rectangle has a distance to the smaller one, evenly from 0 to 1: its mean
/// square is 1 / 3 on a quarter of all samples. Only one direction sees it.
TEST(SurfaceReference, sees_what_only_one_of_the_surfaces_has)
{
    const TriangleMesh small = make_rectangle(1.0, 0.0);
    const TriangleMesh large = make_rectangle(2.0, 0.0);

    for (const SurfaceError& error : {SurfaceReference(small, kSamples).error_of(large),
                                      SurfaceReference(large, kSamples).error_of(small)})
    {
        EXPECT_NEAR(error.rms, std::sqrt(1.0 / 12.0), 1e-3);
        EXPECT_NEAR(error.max, 1.0, 0.01);
    }
}

} // namespace

} // namespace tactus::bench
