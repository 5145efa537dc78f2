// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/refiner.hpp"
#include "rt_core/refine/work_pace.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

class ModelSet;
struct FrameAccount;
struct FrameParts;
struct ModelSlot;

/// Second stage of a frame: gathers the pairs' requests to their models, merges records that no
/// request needs, and shares the frame's splits among waiting requests (SplitShares). Merges and
/// splits ahead of the tools may wait and have a steady pace (WorkPace). Haptic thread. Cost: about
/// 10,000 instructions a split with its search, refit and later merge
/// (docs/benchmarks/callgrind.json), and linear in the nodes and triangles near each request that
/// has no certificate.
class Refinement
{
public:
    /// `has_meshes`: tools are meshes, so each model is refitted at once after a change, as others
    /// query its surface.
    explicit Refinement(bool has_meshes) noexcept : has_meshes_(has_meshes) {}

    /// Runs the stage. Returns the highest priority class of a pair for which a face did not fit;
    /// kPriorityClasses: none.
    [[nodiscard]] std::uint32_t run(FrameParts& parts,
                                    FrameAccount& account) noexcept TACTUS_NONBLOCKING;

private:
    void group(ModelSet& models) noexcept;
    [[nodiscard]] std::span<const RefineRequest> requests_of(const ModelSlot& slot) const noexcept;
    void merge(FrameParts& parts, FrameAccount& account) noexcept;
    void share_splits(FrameParts& parts, FrameAccount& account, SplitLimits limits) noexcept;
    void serve_again(FrameParts& parts, FrameAccount& account, SplitLimits limits) noexcept;
    void serve(FrameParts& parts, FrameAccount& account, std::uint32_t request,
               SplitLimits limits) noexcept;
    [[nodiscard]] std::uint32_t refused_class() const noexcept;
    [[nodiscard]] FrameFault lateness_of(std::uint32_t request) const noexcept;

    bool has_meshes_{false};
    WorkPace pace_;
    bool had_no_room_{false}; ///< True if the last frame lacked capacity.
    RefineRequests requests_; ///< Requests in the order of their pairs' priority.
    RefineRequests by_model_; ///< The same requests, grouped by model.
    /// Result of the last service of a request in this frame.
    struct Service
    {
        SplitLimits limits;      ///< Limits on the splits at that time.
        std::uint32_t splits{0}; ///< Number of splits in this frame after the service.
        FrameFault found{FrameFault::none};
    };
    std::array<Service, kMaxRequests> services_{};
};

} // namespace tactus
