// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/face_decision.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/contact_set.hpp"
#include "rt_core/query/placed_blocks.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): distances are written before each look.
FaceDecision::FaceDecision(const MeshQuestion& question, MeshFindings& findings,
                           MeshMemory& memory) noexcept
    : question_(question)
    , findings_(findings)
    , memory_(memory)
    , tool_quantum_m_(static_cast<double>(question.tool.quantum_m()) * question.place.place.scale)
    , quantum_m_(static_cast<double>(question.object.quantum_m()))
{
}

void FaceDecision::add(const FacePair& pair, bool is_open, const PlacedBlock& tool,
                       const BlockGeometry& block, const VertexRows& rows, float slack) noexcept
{
    FacePairQueue& queue = is_open ? open_queue_ : queue_;
    queue.add(pair, tool, block, rows, slack);
    if (queue.is_full())
    {
        is_open ? bound_queued_open() : decide_queued();
    }
}

void FaceDecision::bound_by(const Triangle& tool, const Triangle& face) noexcept
{
    queue_.add(memory_.faces, tool, face, quantum_m_);
    question_.object.kernels().pair_distances(queue_.rows(), 1, distances_);
    queue_.clear();
    take_bound(0, memory_.faces);
}

void FaceDecision::bound_queued_open() noexcept
{
    const std::uint32_t count = open_queue_.size();
    if (count == 0)
    {
        return;
    }
    question_.object.kernels().pair_distances(open_queue_.rows(), count, distances_);
    for (std::uint32_t lane = 0; lane < count; ++lane)
    {
        const FacePair& pair = open_queue_[lane];
        const double gap_m = static_cast<double>(distances_.lower[lane]) * quantum_m_;
        const double lower_m = gap_m - (tool_error_m(pair) + object_error_m(pair)) * kRoundedUp;
        if (lower_m > findings_.worth_m() ||
            (lower_m >= findings_.open_m() && gap_m >= findings_.bound_m()))
        {
            continue;
        }
        const MeshFace tool{tool_triangle(pair), tool_error_m(pair)};
        const MeshFace face{object_triangle(pair), object_error_m(pair)};
        if (lower_m > 0.0)
        {
            findings_.leave(lower_m);
        }
        else if (findings_.open_m() > 0.0)
        {
            leave_open(tool, face);
        }
        if (gap_m < findings_.bound_m() && !is_outdated(pair))
        {
            findings_.take_upper(corners_apart(tool.triangle, face.triangle));
        }
    }
    open_queue_.clear();
}

void FaceDecision::decide_queued() noexcept
{
    const std::uint32_t count = queue_.size();
    if (count == 0)
    {
        return;
    }
    const PairSides sides = question_.object.kernels().decide_pairs(queue_.rows(), count);
    std::uint32_t apart = sides.apart;
    for (std::uint32_t left = ((1U << count) - 1) & ~sides.apart;
         left != 0 && !findings_.is_enough(); left &= left - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
        const FacePair& pair = queue_[lane];
        if ((sides.meet >> lane & 1U) != 0 || do_meet(pair))
        {
            memory_.faces = pair;
            add_meeting(pair);
        }
        else
        {
            apart |= 1U << lane;
        }
    }
    if (apart != 0 && findings_.measured_m() >= 0.0)
    {
        bound_distances(apart, count);
    }
    queue_.clear();
}

void FaceDecision::measure_candidates() noexcept
{
    const auto is_farther = [](const Candidate& a, const Candidate& b) { return a.gap > b.gap; };
    std::ranges::make_heap(candidates_, is_farther);
    while (!candidates_.empty())
    {
        const double gap_m = gap_of(candidates_[0]);
        if (gap_m > findings_.measured_m())
        {
            break;
        }
        if (gap_m > findings_.contact_zone_m())
        {
            measure_ends();
            break;
        }
        std::ranges::pop_heap(candidates_, is_farther);
        measure(candidates_.pop_back().pair);
    }
    for (const Candidate& candidate : candidates_)
    {
        leave(candidate);
    }
    candidates_.clear();
}

void FaceDecision::add_meeting(const FacePair& pair) noexcept
{
    const double error_m = tolerated_m(pair);
    if (error_m > 0.0)
    {
        findings_.take_upper(corners_apart(tool_triangle(pair), object_triangle(pair)));
    }
    findings_.add_meeting(meeting_of(pair), error_m);
}

bool FaceDecision::do_meet(const FacePair& pair) const noexcept
{
    return meet(tool_triangle(pair), object_triangle(pair));
}

Meeting FaceDecision::meeting_of(const FacePair& pair) const noexcept
{
    const PrimId tool_prim = question_.tool.side(pair.tool_block).prims[pair.tool_lane];
    const PrimId prim = question_.object.side(pair.block).prims[pair.lane];
    return {{question_.tool.face_of(tool_prim), question_.object.face_of(prim)}, tool_prim, prim};
}

/// Bounds the distances of the queued pairs in `apart`, one bit each, which do not meet.
void FaceDecision::bound_distances(std::uint32_t apart, std::uint32_t count) noexcept
{
    question_.object.kernels().pair_distances(queue_.rows(), count, distances_);
    for (; apart != 0; apart &= apart - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(apart));
        const Candidate candidate{queue_[lane], distances_.lower[lane]};
        if (gap_of(candidate) > findings_.measured_m())
        {
            leave(candidate);
            continue;
        }
        take_bound(lane, candidate.pair);
        findings_.count_contact(distances_.upper[lane]);
        if (candidates_.full())
        {
            make_room();
        }
        candidates_.push_back(candidate);
    }
}

/// Makes room in the full list: drops candidates that can no longer be nearest or contacts, except
/// for the possible ends, one per direction. If the list stays nearly full, measures all
/// candidates.
void FaceDecision::make_room() noexcept
{
    const double contact_m = findings_.contact_zone_m();
    const FarthestEnds farthest = farthest_ends();
    std::size_t left = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
    {
        const bool stays =
            gap_of(candidates_[i]) <= contact_m || std::ranges::find(farthest, i) != farthest.end();
        if (!stays)
        {
            leave(candidates_[i]);
        }
        candidates_[left] = candidates_[i];
        left += stays ? 1U : 0U;
    }
    while (candidates_.size() > left)
    {
        candidates_.pop_back();
    }
    if (4 * left > 3 * kMaxCandidates)
    {
        measure_candidates();
    }
}

/// Takes the upper bound of a pair as a bound on the surfaces' distance. If it is the lowest so
/// far, stores the pair and its direction.
void FaceDecision::take_bound(std::uint32_t lane, const FacePair& pair) noexcept
{
    const double upper_m = static_cast<double>(distances_.upper[lane]) * quantum_m_ * kRoundedUp;
    if (!findings_.try_bound(upper_m, tolerated_m(pair) == 0.0))
    {
        return;
    }
    memory_.faces = pair;
    ++way_number_;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        way_[axis] = distances_.way[axis][lane] * kWayRoundedDown;
    }
}

double FaceDecision::gap_of(const Candidate& candidate) const noexcept
{
    return static_cast<double>(candidate.gap) * quantum_m_;
}

void FaceDecision::measure(const FacePair& pair) noexcept
{
    const Triangle tool = tool_triangle(pair);
    const Triangle triangle = object_triangle(pair);
    const double error_m = tolerated_m(pair);
    if (error_m > 0.0)
    {
        findings_.take_upper(corners_apart(tool, triangle));
    }
    findings_.add_apart(meeting_of(pair).faces, triangle, shared_.closest_points(tool, triangle),
                        error_m);
}

/// Leaves a pair that is neither nearest nor a contact unmeasured. If it is coarse, its bound less
/// its error still bounds the original surface.
void FaceDecision::leave(const Candidate& candidate) noexcept
{
    const double error_m = tolerated_m(candidate.pair);
    if (error_m > 0.0)
    {
        findings_.tolerate(gap_of(candidate), error_m);
    }
}

/// Finds the candidate that may be the farthest end in each direction, of those that could only be
/// ends. Returns indices; kMaxCandidates if none may be farther than the known end.
FaceDecision::FarthestEnds FaceDecision::farthest_ends() const noexcept
{
    FarthestEnds farthest{};
    farthest.fill(kMaxCandidates);
    if (question_.ends == nullptr)
    {
        return farthest;
    }
    const double contact_m = findings_.contact_zone_m();
    const double asked_m = findings_.measured_m();
    EndReaches most_m = question_.ends->reaches_m;
    if (question_.ends->is_empty)
    {
        most_m.fill(-kInfinity);
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i)
    {
        const double gap_m = gap_of(candidates_[i]);
        if (gap_m <= contact_m || gap_m > asked_m)
        {
            continue;
        }
        const FacePair& pair = candidates_[i].pair;
        const EndReaches reaches_m = most_end_reaches(object_triangle(pair), gap_m);
        const bool is_any = is_farther_in_any(reaches_m, most_m);
        for (std::size_t end = 0; is_any && end < kContactDirections; ++end)
        {
            std::size_t& place = farthest[end];
            if (reaches_m[end] > most_m[end] ||
                (reaches_m[end] == most_m[end] && place != kMaxCandidates &&
                 comes_before(meeting_of(pair).faces, meeting_of(candidates_[place].pair).faces)))
            {
                place = i;
                most_m[end] = reaches_m[end];
            }
        }
    }
    return farthest;
}

/// Measures the farthest possible end of each direction. Other candidates near the same end would
/// serve as well.
void FaceDecision::measure_ends() noexcept
{
    const FarthestEnds farthest = farthest_ends();
    for (const std::size_t& place : farthest)
    {
        const bool is_first = std::find(farthest.begin(), &place, place) == &place;
        if (is_first && place != kMaxCandidates)
        {
            measure(candidates_[place].pair);
        }
    }
}

double FaceDecision::tool_error_m(const FacePair& pair) const noexcept
{
    const ErrorCode error = question_.tool.side(pair.tool_block).errors[pair.tool_lane];
    return static_cast<double>(error_in_quanta(error)) * tool_quantum_m_ * kRoundedUp;
}

bool FaceDecision::is_outdated(const FacePair& pair) const noexcept
{
    return (question_.object.side(pair.block).outdated >> pair.lane & 1U) != 0;
}

double FaceDecision::object_error_m(const FacePair& pair) const noexcept
{
    const ErrorCode error = question_.object.side(pair.block).errors[pair.lane];
    return static_cast<double>(error_in_quanta(error)) * quantum_m_;
}

/// Error of a pair of faces that count as the surface, rounded up; 0 if both are exact.
double FaceDecision::tolerated_m(const FacePair& pair) const noexcept
{
    if (!question_.is_tolerant())
    {
        return 0.0;
    }
    const bool is_tool_coarse =
        (question_.tool.side(pair.tool_block).coarse >> pair.tool_lane & 1U) != 0;
    const bool is_coarse = (question_.object.side(pair.block).coarse >> pair.lane & 1U) != 0;
    return ((is_tool_coarse ? tool_error_m(pair) : 0.0) +
            (is_coarse ? object_error_m(pair) : 0.0)) *
           kRoundedUp;
}

Triangle FaceDecision::tool_triangle(const FacePair& pair) const noexcept
{
    return placed_triangle(
        to_triangle(block_triangle(question_.tool.block(pair.tool_block), pair.tool_lane)),
        question_.place);
}

Triangle FaceDecision::object_triangle(const FacePair& pair) const noexcept
{
    return to_triangle(block_triangle(question_.object.block(pair.block), pair.lane));
}

void FaceDecision::leave_open(const MeshFace& tool_face, const MeshFace& face) noexcept
{
    const ClosestPoints closest = closest_points(tool_face.triangle, face.triangle);
    findings_.leave(closest.distance - closest.distance_error - tool_face.error_m - face.error_m);
}

} // namespace tactus
