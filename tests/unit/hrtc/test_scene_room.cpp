// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/scene_room.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{
namespace
{

using hrtc::SceneRoom;

constexpr std::size_t kKiB = 1'024;

TEST(SceneRoom, grows_with_the_pools_between_its_limits)
{
    for (const std::size_t pool : {std::size_t{0}, 256 * kKiB})
    {
        EXPECT_EQ(SceneRoom::of(pool).objects, 64U);
        EXPECT_EQ(SceneRoom::of(pool).pairs, 16U);
    }
    EXPECT_EQ(SceneRoom::of(2'048 * kKiB).objects, 512U);
    EXPECT_EQ(SceneRoom::of(2'048 * kKiB).pairs, 32U);
    EXPECT_EQ(SceneRoom::of(4'096 * kKiB).pairs, kMaxPairs);
    EXPECT_EQ(SceneRoom::of(16'384 * kKiB).objects, kMaxObjects);
    EXPECT_EQ(SceneRoom::of(std::size_t{4'096} * 1'024 * kKiB).objects, kMaxObjects);
    EXPECT_EQ(SceneRoom::of(std::size_t{4'096} * 1'024 * kKiB).pairs, kMaxPairs);
}

} // namespace
} // namespace tactus::test
