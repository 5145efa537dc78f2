// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/index_search.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/four_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tactus
{

namespace
{

/// Bound on double precision's rounding of a distance in quanta, as a share of it.
constexpr double kRounding = 1e-12;

/// Motion of a sphere's centre, plus the growth of the wider sphere.
double way_between(const QuantumSphere& before, const QuantumSphere& now) noexcept
{
    double moved_sq = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double moved = now.center[axis] - before.center[axis];
        moved_sq += moved * moved;
    }
    return std::sqrt(moved_sq) + IndexSearch::kWider * std::max(now.radius - before.radius, 0.0);
}

std::int32_t in_range(double value) noexcept
{
    constexpr double kLow = std::numeric_limits<std::int32_t>::lowest();
    constexpr double kHigh = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(value, kLow, kHigh));
}

} // namespace

SphereLanes::SphereLanes(std::span<const WantedSphere> spheres, double wider) noexcept
    : around_(spheres[0].sphere.center)
{
    std::array<double, 4> most{};
    for (const WantedSphere& wanted : spheres)
    {
        const double radius = wanted.sphere.radius * wider;
        KernelSphere lane{{}, static_cast<float>(radius)};
        most[3] = std::max(most[3], radius);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double at = wanted.sphere.center[axis] - around_[axis];
            lane.center[axis] = static_cast<float>(at);
            most[axis] = std::max(most[axis], std::abs(at));
        }
        lanes_.push_back(lane);
    }
    size_ = most[0] + most[1] + most[2] + most[3];
}

KernelPage SphereLanes::page(const QuantumBox& box) const noexcept
{
    // Rounding of a gap, as a share of the sum of all sizes: less than 8 x 2^-24, as steps of less
    // than 18 bits are exact.
    constexpr double kSlack = 0x1p-20;
    // Squares of larger sizes may overflow: single precision then decides nothing.
    constexpr double kLargest = 1e18;
    KernelPage page{};
    double size = size_;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double low = static_cast<double>(box.low[axis]) - around_[axis];
        const double step = index_step(box.low[axis], box.high[axis]);
        page.low[axis] = static_cast<float>(low);
        page.step[axis] = static_cast<float>(step);
        size += std::abs(low) + 65'535.0 * step;
    }
    page.slack = size < kLargest ? static_cast<float>(size * kSlack)
                                 : std::numeric_limits<float>::infinity();
    return page;
}

void IndexSearch::aim(const Spheres& spheres, std::uint32_t pages, std::uint32_t frame,
                      bool keeps_rounds) noexcept
{
    pages_ = pages;
    spheres_ = spheres.view();
    wider_ = keeps_rounds ? kWider : 1.0;
    if (spheres.empty())
    {
        // No page touched before is in use any more.
        is_kept_ = false;
        has_due_ = false;
        near_.clear();
        pages_left_ = 0;
        round_began_ = frame;
        last_round_began_ = frame;
        return;
    }
    const std::optional<double> way = keeps_rounds && is_kept_ ? way_of(spheres) : std::nullopt;
    way_ += way.value_or(0.0);
    if (!way || !(way_ <= margin_) || (pages_left_ == 0 && frame - ended_ > kRestFrames))
    {
        is_kept_ = keeps_rounds && spheres.size() <= kKeptSpheres;
        begin_round(spheres, way.value_or(0.0), frame);
        kept_.clear();
    }
    if (is_kept_)
    {
        keep(spheres);
    }
    find_due();
}

/// Largest motion of a sphere since the last frame; none if the number of spheres of a level
/// changed.
std::optional<double> IndexSearch::way_of(const Spheres& spheres) const noexcept
{
    if (spheres.size() != kept_.size())
    {
        return std::nullopt;
    }
    double way = 0.0;
    for (std::size_t i = 0; i < spheres.size(); ++i)
    {
        const auto is_first = [i](const auto& of)
        { return i > 0 && of[i].level != of[i - 1].level; };
        if (is_first(spheres) != is_first(kept_))
        {
            return std::nullopt;
        }
        way = std::max(way, way_between(kept_[i].sphere, spheres[i].sphere));
    }
    return way;
}

void IndexSearch::begin_round(const Spheres& spheres, double way, std::uint32_t frame) noexcept
{
    double smallest = spheres[0].sphere.radius;
    std::array<double, 3> low = spheres[0].sphere.center;
    std::array<double, 3> high = low;
    for (const auto& [sphere, level] : spheres)
    {
        smallest = std::min(smallest, sphere.radius);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], sphere.center[axis] - sphere.radius * wider_);
            high[axis] = std::max(high[axis], sphere.center[axis] + sphere.radius * wider_);
        }
    }
    margin_ = is_kept_
                  ? std::clamp(way * kRestFrames, kLeastMargin * smallest, kMostMargin * smallest)
                  : 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        region_.low[axis] = in_range(std::floor(low[axis] - margin_) - 1.0);
        region_.high[axis] = in_range(std::ceil(high[axis] + margin_) + 1.0);
    }
    way_ = 0.0;
    near_.clear();
    turn_ = 0;
    pages_left_ = pages_;
    ended_ = frame;
}

/// Keeps the frame's spheres, each with its level of highest priority in the round. If one has
/// a higher priority than before, the pages that it meets must be touched again.
void IndexSearch::keep(const Spheres& spheres) noexcept
{
    bool is_more_urgent = false;
    for (std::size_t i = 0; i < spheres.size(); ++i)
    {
        if (i == kept_.size())
        {
            kept_.push_back(spheres[i]);
        }
        is_more_urgent = is_more_urgent || spheres[i].level < kept_[i].level;
        kept_[i] = {spheres[i].sphere, std::min(spheres[i].level, kept_[i].level)};
    }
    for (NearPage& near : near_)
    {
        if (is_more_urgent)
        {
            near.until.fill(kNow);
        }
    }
}

void IndexSearch::find_due() noexcept
{
    static_assert(kGroups == 8);
    const FourFloats way = FourFloats{} + static_cast<float>(way_);
    turns_left_ = near_.size();
    has_due_ = false;
    for (NearPage& near : near_)
    {
        std::array<FourFloats, 2> until{};
        std::memcpy(&until, near.until.data(), sizeof until);
        near.due = bits_of(until[0] < way) | bits_of(until[1] < way) << 4U;
        has_due_ = has_due_ || near.due != 0;
    }
}

IndexSearch::NearPage* IndexSearch::next_due() noexcept
{
    while (turns_left_ > 0)
    {
        --turns_left_;
        NearPage& near = near_[turn_];
        turn_ = turn_ + 1 == near_.size() ? 0 : turn_ + 1;
        if (near.due != 0)
        {
            return &near;
        }
    }
    return nullptr;
}

IndexPageId IndexSearch::next(std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(is_on_round());
    const IndexPageId page{cursor_};
    TACTUS_ASSERT(page.value < pages_);
    cursor_ = cursor_ + 1 >= pages_ ? 0 : cursor_ + 1;
    if (cursor_ == 0)
    {
        last_round_began_ = round_began_;
        round_began_ = frame;
    }
    --pages_left_;
    ended_ = frame;
    return page;
}

bool IndexSearch::may_come_to(const QuantumBox& box) const noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (box.low[axis] > region_.high[axis] || box.high[axis] < region_.low[axis])
        {
            return false;
        }
    }
    const double further = std::max(margin_ - way_, 0.0) * (1.0 + kRounding);
    return std::ranges::any_of(
        spheres_,
        [&](const WantedSphere& wanted) {
            return meets({wanted.sphere.center, wanted.sphere.radius * wider_ + further}, box);
        });
}

IndexSearch::NearPage& IndexSearch::add(IndexPageId page) noexcept
{
    const NearPage near{page, kAllGroups, false, {}};
    if (is_kept_ && near_.try_push_back(near))
    {
        return near_[near_.size() - 1];
    }
    is_kept_ = false;
    unlisted_ = near;
    return unlisted_;
}

std::optional<double> IndexSearch::gap_to(const QuantumBox& box, double wider) const noexcept
{
    double least = std::numeric_limits<double>::infinity();
    for (const WantedSphere& wanted : spheres_)
    {
        const double far_sq = distance_sq(wanted.sphere.center, box);
        const double radius = wanted.sphere.radius * wider;
        if (far_sq <= radius * radius)
        {
            return std::nullopt;
        }
        least = std::min(least, std::sqrt(far_sq) * (1.0 - kRounding) - radius);
    }
    return std::max(least, 0.0);
}

IndexSearch::NearPage* IndexSearch::find(IndexPageId page) noexcept
{
    auto* const found = std::ranges::find(near_, page, &NearPage::page);
    return found == near_.end() ? nullptr : found;
}

void IndexSearch::forget(IndexPageId page) noexcept
{
    if (NearPage* const near = find(page); near != nullptr)
    {
        near->is_met = false;
        near->until.fill(kNow);
    }
}

void IndexSearch::forget(ChunkId chunk) noexcept
{
    if (NearPage* const near = find({chunk.value >> kChunksPerIndexPageLog2}); near != nullptr)
    {
        near->until[chunk.value % kChunksPerIndexPage / 8] = kNow;
    }
}

} // namespace tactus
