// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/index_search.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kFrame = 1'000;
constexpr std::uint32_t kPagesInRound = 5;

IndexSearch::Spheres one_sphere(double x, double radius = 10.0, std::uint32_t level = 0)
{
    IndexSearch::Spheres spheres;
    spheres.push_back({{{x, 0.0, 0.0}, radius}, level});
    return spheres;
}

/// Point box at x.
QuantumBox box_at(std::int32_t x)
{
    return {{x, 0, 0}, {x, 0, 0}};
}

using Pages = std::vector<std::uint32_t>;

/// Frames in which `pages` pages are checked. The search refers to the spheres until the next
/// frame.
class SearchRig
{
public:
    Pages look(const IndexSearch::Spheres& spheres, std::uint32_t pages = kPagesInRound,
               bool keeps_rounds = true)
    {
        ++frame;
        spheres_ = spheres;
        sut.aim(spheres_, kPagesInRound, frame, keeps_rounds);
        Pages looked;
        while (looked.size() < pages && sut.is_on_round())
        {
            looked.push_back(sut.next(frame).value);
        }
        return looked;
    }
    /// Adds a page to the list, with the same certificate for all of its groups.
    void list(std::uint32_t page, double gap)
    {
        IndexSearch::NearPage& near = sut.add({page});
        near.due = 0;
        near.until.fill(sut.until(gap));
    }
    Pages due()
    {
        Pages pages;
        while (const IndexSearch::NearPage* near = sut.next_due())
        {
            EXPECT_EQ(near->due, IndexSearch::kAllGroups);
            pages.push_back(near->page.value);
        }
        return pages;
    }

    IndexSearch sut{kFrame};
    std::uint32_t frame{kFrame};

private:
    IndexSearch::Spheres spheres_;
};

TEST(IndexSearch, rests_without_spheres)
{
    SearchRig rig;
    EXPECT_TRUE(rig.look({}).empty());
    EXPECT_TRUE(rig.sut.is_at_rest());
    EXPECT_EQ(rig.sut.last_round_began(), rig.frame) << "nothing was of use before";
}

TEST(IndexSearch, goes_round_in_parts_and_then_rests)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_sphere(0), 2), (Pages{0, 1}));
    EXPECT_EQ(rig.look(one_sphere(0), 2), (Pages{2, 3}));
    EXPECT_EQ(rig.look(one_sphere(0), 2), Pages{4});
    for (std::uint32_t i = 0; i < IndexSearch::kRestFrames; ++i)
    {
        EXPECT_TRUE(rig.look(one_sphere(0)).empty()) << i;
        EXPECT_TRUE(rig.sut.is_at_rest()) << i;
    }
    EXPECT_EQ(rig.look(one_sphere(0)), (Pages{0, 1, 2, 3, 4}));
}

TEST(IndexSearch, begins_a_round_when_the_spheres_went_and_grew_farther_than_its_margin)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_sphere(0)).size(), kPagesInRound);
    EXPECT_TRUE(rig.look(one_sphere(0.5)).empty()) << "a tenth of the radius";
    EXPECT_TRUE(rig.look(one_sphere(0.1)).empty());
    EXPECT_EQ(rig.look(one_sphere(-0.1)).size(), kPagesInRound) << "for any way";
    EXPECT_TRUE(rig.look(one_sphere(-0.1, 9.0)).empty()) << "smaller ones are no matter";
    EXPECT_TRUE(rig.look(one_sphere(-0.1, 10.0)).empty());
    EXPECT_TRUE(rig.look(one_sphere(-0.1, 10.5)).empty());
    EXPECT_EQ(rig.look(one_sphere(-0.1, 12.5)).size(), kPagesInRound);
}

TEST(IndexSearch, has_a_margin_for_a_rest_at_the_spheres_speed)
{
    SearchRig rig;
    rig.look(one_sphere(0));
    rig.look(one_sphere(1.5)); // One round, whose margin is for 16 frames, at most the radius.
    std::uint32_t rests = 0;
    for (double x = 2.0; rig.look(one_sphere(x)).empty(); x += 0.5)
    {
        ++rests;
    }
    EXPECT_EQ(rests, IndexSearch::kRestFrames);
    rig.look(one_sphere(100.0));
    EXPECT_TRUE(rig.look(one_sphere(109.9)).empty());
    EXPECT_EQ(rig.look(one_sphere(110.1)).size(), kPagesInRound);
}

TEST(IndexSearch, begins_a_round_for_other_spheres)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_sphere(0)).size(), kPagesInRound);
    IndexSearch::Spheres two = one_sphere(0, 10.0, 1);
    two.push_back(two[0]);
    EXPECT_EQ(rig.look(two).size(), kPagesInRound);
    two[1].level = 2;
    EXPECT_EQ(rig.look(two).size(), kPagesInRound) << "no longer of one level";
    EXPECT_TRUE(rig.look({}).empty());
    EXPECT_EQ(rig.look(two).size(), kPagesInRound);
}

TEST(IndexSearch, looks_at_all_that_is_listed_when_a_sphere_becomes_more_urgent_than_in_the_round)
{
    SearchRig rig;
    rig.look(one_sphere(0, 10.0, 2));
    rig.list(3, 5.0);
    EXPECT_TRUE(rig.look(one_sphere(0, 10.0, 4)).empty());
    EXPECT_TRUE(rig.sut.is_at_rest());
    EXPECT_EQ(rig.sut.touch_level(0), 2U);
    EXPECT_TRUE(rig.look(one_sphere(0, 10.0, 1)).empty());
    EXPECT_EQ(rig.due(), Pages{3});
    EXPECT_EQ(rig.sut.touch_level(0), 1U);
    rig.look(one_sphere(100.0, 10.0, 2));
    EXPECT_EQ(rig.sut.touch_level(0), 2U) << "another round";
}

TEST(IndexSearch, begins_anew_when_told)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_sphere(0)).size(), kPagesInRound);
    rig.sut.begin_again();
    EXPECT_EQ(rig.look(one_sphere(0)).size(), kPagesInRound);
}

TEST(IndexSearch, lists_what_a_sphere_may_come_to_within_the_margin)
{
    SearchRig rig;
    rig.look(one_sphere(0, 100.0));
    EXPECT_TRUE(rig.sut.may_come_to(box_at(109))) << "a tenth wider";
    EXPECT_TRUE(rig.sut.may_come_to(box_at(119)));
    EXPECT_FALSE(rig.sut.may_come_to(box_at(121)));
    EXPECT_FALSE(rig.sut.may_come_to({{86, 86, 0}, {90, 90, 0}})) << "a corner";
    rig.look(one_sphere(6, 100.0));
    EXPECT_TRUE(rig.sut.may_come_to(box_at(119))) << "six of the ten are used up";
    EXPECT_FALSE(rig.sut.may_come_to(box_at(121)));
    EXPECT_FALSE(rig.sut.gap_to(box_at(106), 1.0));
    EXPECT_NEAR(rig.sut.gap_to(box_at(110), 1.0).value(), 4.0, 1e-9);
    EXPECT_FALSE(rig.sut.gap_to(box_at(110), rig.sut.wider()));
}

TEST(IndexSearch, looks_at_a_listed_page_when_the_spheres_have_gone_as_far_as_its_gap)
{
    SearchRig rig;
    rig.look(one_sphere(0, 100.0));
    rig.list(3, 5.0);
    rig.list(1, 2.0);
    EXPECT_TRUE(rig.look(one_sphere(1.9, 100.0)).empty());
    EXPECT_TRUE(rig.sut.is_at_rest());
    rig.look(one_sphere(2.1, 100.0));
    EXPECT_FALSE(rig.sut.is_at_rest());
    EXPECT_EQ(rig.due(), Pages{1});
    rig.look(one_sphere(5.1, 100.0));
    EXPECT_EQ(rig.due(), (Pages{3, 1})) << "it was not looked at";
    EXPECT_TRUE(rig.due().empty()) << "each once a frame";
}

TEST(IndexSearch, takes_listed_pages_in_turn_where_a_frame_does_not_get_to_all)
{
    SearchRig rig;
    rig.look(one_sphere(0, 100.0));
    for (const std::uint32_t page : {0U, 1U, 2U})
    {
        rig.list(page, 0.5);
    }
    Pages first;
    for (int i = 0; i < 6; ++i)
    {
        rig.look(one_sphere(1.0, 100.0));
        first.push_back(rig.sut.next_due()->page.value);
    }
    EXPECT_EQ(first, (Pages{0, 1, 2, 0, 1, 2}));
}

TEST(IndexSearch, forgets_certificates_of_what_came_or_went)
{
    SearchRig rig;
    rig.look(one_sphere(0, 100.0));
    rig.list(2, 5.0);
    rig.list(3, 5.0);
    rig.sut.forget(IndexPageId{2});
    rig.sut.forget(IndexPageId{4});
    rig.look(one_sphere(0, 100.0));
    EXPECT_EQ(rig.due(), Pages{2});
    rig.sut.forget(ChunkId{3 * 64 + 17});
    rig.look(one_sphere(0, 100.0));
    ASSERT_EQ(rig.sut.next_due()->page, IndexPageId{2});
    const IndexSearch::NearPage* near = rig.sut.next_due();
    ASSERT_NE(near, nullptr);
    EXPECT_EQ(near->page, IndexPageId{3});
    EXPECT_EQ(near->due, 1U << 2U);
}

TEST(IndexSearch, begins_a_round_each_frame_when_the_list_is_full)
{
    SearchRig rig;
    rig.look(one_sphere(0));
    for (std::uint32_t i = 0; i < IndexSearch::kMaxNear; ++i)
    {
        rig.list(i, 1e9);
    }
    EXPECT_TRUE(rig.look(one_sphere(0)).empty());
    rig.list(0, 1e9);
    EXPECT_EQ(rig.look(one_sphere(0)).size(), kPagesInRound);
}

TEST(IndexSearch, keeps_no_round_when_told_so_or_for_too_many_spheres)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_sphere(0), kPagesInRound, false).size(), kPagesInRound);
    EXPECT_EQ(rig.look(one_sphere(0), kPagesInRound, false).size(), kPagesInRound);
    EXPECT_FALSE(rig.sut.may_come_to(box_at(12))) << "no margin";
    IndexSearch::Spheres many;
    for (std::size_t i = 0; i <= IndexSearch::kKeptSpheres; ++i)
    {
        many.push_back(one_sphere(0)[0]);
    }
    EXPECT_EQ(rig.look(many).size(), kPagesInRound);
    EXPECT_EQ(rig.look(many).size(), kPagesInRound);
}

TEST(IndexSearch, tells_when_the_round_before_the_last_began)
{
    SearchRig rig;
    rig.look(one_sphere(0), kPagesInRound, false);
    rig.look(one_sphere(0), kPagesInRound, false);
    EXPECT_EQ(rig.sut.last_round_began(), kFrame + 1);
    rig.look(one_sphere(0), kPagesInRound, false);
    EXPECT_EQ(rig.sut.last_round_began(), kFrame + 2);
}

} // namespace
} // namespace tactus::test
