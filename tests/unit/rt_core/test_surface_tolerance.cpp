// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/surface_tolerance.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

using Room = SurfaceTolerance::Room;

constexpr SurfaceTolerance::Range kRange{20, 31};

ErrorCode after(SurfaceTolerance& sut, Room room, int frames)
{
    for (int frame = 0; frame < frames; ++frame)
    {
        sut.fit(kRange, room, true);
    }
    return sut.code();
}

} // namespace

TEST(SurfaceTolerance, is_the_least_while_that_fits)
{
    SurfaceTolerance sut;

    EXPECT_EQ(after(sut, Room::fitting, 1), kRange.least);
    EXPECT_EQ(after(sut, Room::fitting, 1'000), kRange.least);
    EXPECT_EQ(after(sut, Room::enough, 1'000), kRange.least);
}

TEST(SurfaceTolerance, doubles_where_something_stays_short_and_ends_at_the_most)
{
    SurfaceTolerance sut;
    (void)after(sut, Room::fitting, 1);

    EXPECT_EQ(after(sut, Room::short_, 5), 20);
    EXPECT_EQ(after(sut, Room::short_, 1), 24);
    EXPECT_EQ(after(sut, Room::short_, 6), 28);
    EXPECT_EQ(after(sut, Room::short_, 6), kRange.most);
    EXPECT_EQ(after(sut, Room::short_, 1'000), kRange.most);
}

TEST(SurfaceTolerance, waits_longer_for_what_is_only_late)
{
    SurfaceTolerance sut;
    (void)after(sut, Room::fitting, 1);

    EXPECT_EQ(after(sut, Room::late, 23), 20);
    EXPECT_EQ(after(sut, Room::late, 1), 24);
    EXPECT_EQ(after(sut, Room::late, 12), 24);
    EXPECT_EQ(after(sut, Room::short_, 3), 28);
}

TEST(SurfaceTolerance, shrinks_slowly_and_only_with_room_all_the_time)
{
    SurfaceTolerance sut;
    (void)after(sut, Room::short_, 6);

    EXPECT_EQ(after(sut, Room::enough, 29), 24);
    EXPECT_EQ(after(sut, Room::fitting, 1), 24);
    EXPECT_EQ(after(sut, Room::enough, 29), 24);
    EXPECT_EQ(after(sut, Room::enough, 1), 23);
    EXPECT_EQ(after(sut, Room::enough, 1'000), kRange.least);
}

TEST(SurfaceTolerance, one_short_frame_is_none)
{
    SurfaceTolerance sut;
    for (int round = 0; round < 100; ++round)
    {
        EXPECT_EQ(after(sut, Room::short_, 5), kRange.least);
        EXPECT_EQ(after(sut, Room::fitting, 1), kRange.least);
    }
}

TEST(SurfaceTolerance, follows_a_range_that_changes_and_needs_nothing_where_all_is_to_be_exact)
{
    SurfaceTolerance sut;
    (void)after(sut, Room::short_, 12);
    sut.fit({10, 12}, Room::fitting, true);
    EXPECT_EQ(sut.code(), 12);
    sut.fit({}, Room::short_, true);
    EXPECT_EQ(sut.code(), 0);
}

TEST(SurfaceTolerance, queries_go_by_a_coarser_surface_until_a_finer_one_is_there)
{
    SurfaceTolerance sut;
    EXPECT_EQ(after(sut, Room::short_, 6), 24);
    EXPECT_EQ(after(sut, Room::enough, 29), 24);
    EXPECT_EQ(sut.felt(), 24);

    EXPECT_EQ(after(sut, Room::enough, 1), 23);
    EXPECT_EQ(sut.felt(), 28);
    sut.fit(kRange, Room::late, false);
    EXPECT_EQ(sut.felt(), 28);
    sut.fit(kRange, Room::fitting, false); // What is late is not loaded yet.
    EXPECT_EQ(sut.felt(), 28);
    sut.fit(kRange, Room::fitting, true);
    EXPECT_EQ(sut.code(), 23);
    EXPECT_EQ(sut.felt(), 23);
}

TEST(SurfaceTolerance, queries_go_by_a_coarser_surface_at_once)
{
    SurfaceTolerance sut;
    (void)after(sut, Room::fitting, 1);

    for (int frame = 0; frame < 6; ++frame)
    {
        sut.fit(kRange, Room::short_, false);
    }
    EXPECT_EQ(sut.code(), 24);
    EXPECT_EQ(sut.felt(), 24);
    sut.fit({10, 12}, Room::fitting, false);
    EXPECT_EQ(sut.felt(), 12);
}

} // namespace tactus::test
