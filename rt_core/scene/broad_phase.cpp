// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/broad_phase.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Factor by which a list is wider than needed, so that a tool can use it for a while.
constexpr double kWider = 1.5;
/// Frames that a tool waits after a walk filled its list: another walk would find the same objects.
constexpr std::uint32_t kFullWait = 8;
/// Error of a distance between two places, as a share of their coordinates: about ten roundings by
/// 1.1e-16.
constexpr double kGapRounding = 2e-15;
/// Factor on a squared distance, far above its roundings, with which a sphere is still examined.
constexpr double kSquareWidened = 1.0 + 1e-9;

double size_of(const Vec3& place) noexcept
{
    return std::max({std::abs(place.x()), std::abs(place.y()), std::abs(place.z())});
}

/// Lower bound on the distance of a place from a sphere; `square` is the computed squared distance
/// from its centre.
double proven_gap(const Vec3& place, const Sphere& sphere, double square) noexcept
{
    const double length = std::sqrt(square);
    return (length - sphere.radius) -
           kGapRounding * (length + sphere.radius + size_of(place) + size_of(sphere.center));
}

} // namespace

BroadPhase::BroadPhase(Arena& arena, std::uint32_t objects, std::uint32_t tools) noexcept
    : spheres_(arena.take<Sphere>(objects))
    , groups_(arena.take<Group>((objects + kGroup - 1) / kGroup))
    , scratch_(arena.take<Candidate>(objects))
    , tool_count_(tools)
{
    TACTUS_ASSERT(objects <= kMaxObjects);
    TACTUS_ASSERT(tools <= kMaxTools);
    for (std::uint32_t i = 0; i < objects && !arena.is_measuring(); ++i)
    {
        spheres_[i].radius = -1.0;
    }
}

void BroadPhase::place(std::uint32_t object, const Sphere& sphere) noexcept
{
    TACTUS_ASSERT(object < spheres_.size());
    TACTUS_ASSERT(sphere.radius >= 0.0);
    count_ += spheres_[object].radius < 0.0 ? 1U : 0U;
    spheres_[object] = sphere;
    groups_[object / kGroup].is_stale = true;
    for (ToolRange& tool : std::span(tools_).first(tool_count_))
    {
        const double gap_m =
            proven_gap(tool.center_m, sphere, (tool.center_m - sphere.center).squaredNorm());
        if (!tool.is_resident || gap_m > tool.clear_m)
        {
            continue;
        }
        auto* const at = std::ranges::lower_bound(tool.near, object);
        if (at != tool.near.end() && *at == object)
        {
            continue;
        }
        if (gap_m > kWider * tool.near_m || tool.near.full())
        {
            tool.clear_m = gap_m;
            continue;
        }
        const auto place = at - tool.near.begin();
        ++lists_;
        tool.near.push_back(object);
        std::rotate(tool.near.begin() + place, tool.near.end() - 1, tool.near.end());
    }
}

void BroadPhase::remove(std::uint32_t object) noexcept
{
    TACTUS_ASSERT(object < spheres_.size());
    TACTUS_ASSERT(spheres_[object].radius >= 0.0);
    --count_;
    spheres_[object].radius = -1.0;
    groups_[object / kGroup].is_stale = true;
    for (ToolRange& tool : std::span(tools_).first(tool_count_))
    {
        auto* const at = std::ranges::lower_bound(tool.near, object);
        if (at != tool.near.end() && *at == object)
        {
            ++lists_;
            std::move(at + 1, tool.near.end(), at);
            (void)tool.near.pop_back();
        }
    }
}

void BroadPhase::move_tool(std::uint32_t tool, const Vec3& center_m, double near_m) noexcept
{
    TACTUS_ASSERT(tool < tool_count_);
    TACTUS_ASSERT(near_m >= 0.0);
    ToolRange& range = tools_[tool];
    if (center_m != range.center_m && std::isfinite(range.clear_m))
    {
        const double way_m = (center_m - range.center_m).norm();
        range.clear_m -=
            way_m + kGapRounding * (way_m + std::abs(range.clear_m) + size_of(center_m));
    }
    range.is_resident = true;
    range.center_m = center_m;
    range.near_m = near_m;
    walks_ = 0;
    looked_at_ = 0;
}

void BroadPhase::forget(std::uint32_t tool) noexcept
{
    TACTUS_ASSERT(tool < tool_count_);
    ++lists_;
    tools_[tool] = ToolRange{};
}

bool BroadPhase::lacks_proof(const ToolRange& tool) const noexcept
{
    return tool.is_resident && (tool.clear_m < tool.near_m || (tool.near.empty() && count_ > 0));
}

bool BroadPhase::needs_walk(const ToolRange& tool) const noexcept
{
    return lacks_proof(tool) && (!tool.was_full || tool.waited >= kFullWait);
}

void BroadPhase::walk() noexcept
{
    const std::span<ToolRange> tools = std::span(tools_).first(tool_count_);
    for (; walks_ < kBroadWalks; ++walks_)
    {
        ToolRange* next = nullptr;
        for (ToolRange& tool : tools)
        {
            if (needs_walk(tool) && (next == nullptr || tool.waited > next->waited))
            {
                next = &tool;
            }
        }
        if (next == nullptr)
        {
            break;
        }
        walk(*next);
    }
    for (ToolRange& tool : tools)
    {
        tool.waited += lacks_proof(tool) ? 1U : 0U;
    }
}

void BroadPhase::walk(ToolRange& tool) noexcept
{
    Findings found;
    found.wide_m = kWider * tool.near_m;
    for (std::uint32_t i = 0; i < groups_.size(); ++i)
    {
        if (groups_[i].is_stale)
        {
            fit(groups_[i], i * kGroup);
        }
        search(groups_[i], i * kGroup, tool, found);
    }
    keep_nearest(tool, found);
    ++lists_;
    tool.waited = 0;
}

/// Searches a group of objects. An object farther than the second nearest unlisted one changes
/// nothing.
void BroadPhase::search(const Group& group, std::uint32_t first, const ToolRange& tool,
                        Findings& found) noexcept
{
    const Vec3& center = tool.center_m;
    const Vec3 apart =
        greatest_of(greatest_of(group.low - center, center - group.high), Vec3(0.0, 0.0, 0.0));
    const double least = apart.norm() * (1.0 - kGapRounding);
    if (!(least <= std::max(found.wide_m, found.after_m)))
    {
        return;
    }
    const auto count = static_cast<std::uint32_t>(spheres_.size());
    for (std::uint32_t i = first; i < std::min(first + kGroup, count); ++i)
    {
        const Sphere& sphere = spheres_[i];
        const double square = (center - sphere.center).squaredNorm();
        const double far = std::max(found.wide_m, found.after_m) + sphere.radius;
        if (sphere.radius < 0.0 || square > far * far * kSquareWidened)
        {
            continue;
        }
        const double gap_m = proven_gap(center, sphere, square);
        if (gap_m <= found.wide_m)
        {
            scratch_[found.listed++] = {gap_m, i};
        }
        else if (gap_m < found.next.gap_m)
        {
            found.after_m = found.next.gap_m;
            found.next = {gap_m, i};
        }
        else
        {
            found.after_m = std::min(found.after_m, gap_m);
        }
    }
    looked_at_ += kGroup;
}

/// Lists the nearest objects, sorted by number; at least one if there is any.
void BroadPhase::keep_nearest(ToolRange& tool, Findings& found) noexcept
{
    const std::span<Candidate> listed = scratch_.first(found.listed);
    tool.clear_m = found.next.gap_m;
    tool.near.clear();
    tool.was_full = listed.size() > kMaxNear;
    if (tool.was_full)
    {
        const auto by_gap = [](const Candidate& a, const Candidate& b)
        { return a.gap_m < b.gap_m || (a.gap_m == b.gap_m && a.object < b.object); };
        std::ranges::nth_element(listed, listed.begin() + kMaxNear, by_gap);
        tool.clear_m = listed[kMaxNear].gap_m;
    }
    else if (listed.empty() && found.next.gap_m < kInfinity)
    {
        tool.near.push_back(found.next.object);
        tool.clear_m = found.after_m;
    }
    for (const Candidate& candidate : listed.first(std::min<std::size_t>(listed.size(), kMaxNear)))
    {
        tool.near.push_back(candidate.object);
    }
    std::ranges::make_heap(tool.near);
    std::ranges::sort_heap(tool.near);
}

void BroadPhase::fit(Group& group, std::uint32_t first) noexcept
{
    group = Group{};
    const auto count = static_cast<std::uint32_t>(spheres_.size());
    for (const Sphere& sphere : spheres_.subspan(first, std::min(kGroup, count - first)))
    {
        if (sphere.radius >= 0.0)
        {
            const Vec3 half(sphere.radius, sphere.radius, sphere.radius);
            group.low = least_of(group.low, sphere.center - half);
            group.high = greatest_of(group.high, sphere.center + half);
        }
    }
}

double BroadPhase::gap_m(std::uint32_t tool, std::uint32_t object) const noexcept
{
    const Sphere& sphere = spheres_[object];
    TACTUS_ASSERT(sphere.radius >= 0.0);
    const Vec3& center = tools_[tool].center_m;
    return proven_gap(center, sphere, (center - sphere.center).squaredNorm());
}

} // namespace tactus
