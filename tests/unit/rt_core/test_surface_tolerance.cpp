// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/surface_tolerance.hpp"

#include <gtest/gtest.h>

#include <vector>

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

/// Room of some frames, and the tolerance after them.
struct Frames
{
    Room room;
    int frames;
    ErrorCode code;
};

TEST(SurfaceTolerance, grows_where_something_stays_short_and_shrinks_slowly_where_there_is_room)
{
    const std::vector<std::vector<Frames>> runs{
        // It is the least while that fits.
        {{Room::fitting, 1, 20}, {Room::fitting, 1'000, 20}, {Room::enough, 1'000, 20}},
        // It doubles where something stays short, and ends at the most.
        {{Room::fitting, 1, 20},
         {Room::short_, 5, 20},
         {Room::short_, 1, 24},
         {Room::short_, 6, 28},
         {Room::short_, 6, kRange.most},
         {Room::short_, 1'000, kRange.most}},
        // It waits longer for what is only late.
        {{Room::fitting, 1, 20},
         {Room::late, 23, 20},
         {Room::late, 1, 24},
         {Room::late, 12, 24},
         {Room::short_, 3, 28}},
        // It shrinks only with room all the time.
        {{Room::short_, 6, 24},
         {Room::enough, 29, 24},
         {Room::fitting, 1, 24},
         {Room::enough, 29, 24},
         {Room::enough, 1, 23},
         {Room::enough, 1'000, 20}}};
    for (const std::vector<Frames>& run : runs)
    {
        SurfaceTolerance sut;
        for (const auto& [room, frames, code] : run)
        {
            EXPECT_EQ(after(sut, room, frames), code) << &run - runs.data() << ", " << frames;
        }
    }
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
