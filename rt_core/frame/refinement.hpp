// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/refine/work_pace.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// Second stage of a frame: gathers the pairs' requests to their models, merges records that all
/// left behind, and shares the frame's splits among waiting requests (SplitShares). Work that may
/// wait, merges and splits ahead of the tools, has a steady pace (WorkPace). Haptic thread.
class Refinement
{
public:
    /// If tools are meshes, trees are refitted at once, since others query their surfaces.
    explicit Refinement(bool has_meshes) noexcept : has_meshes_(has_meshes) {}

    /// Returns the class of highest priority of pairs for which a face did not fit,
    /// kPriorityClasses if all did.
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
    bool had_no_room_{false}; ///< The last frame lacked capacity for a need.
    RefineRequests requests_; ///< Requests in the order of their pairs.
    RefineRequests by_model_; ///< The same, grouped by model.
    /// Last service of a request in this frame.
    struct Service
    {
        SplitLimits limits;      ///< Limits at that time.
        std::uint32_t splits{0}; ///< Splits of the frame by then.
        FrameFault found{FrameFault::none};
    };
    std::array<Service, kMaxRequests> services_{};
};

} // namespace tactus
