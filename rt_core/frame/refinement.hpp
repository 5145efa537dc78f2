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

/// A frame's second stage: gathers what its pairs ask of their models, merges what all left behind,
/// and shares the frame's splits among those that wait (SplitShares). What may wait, merges and
/// splits ahead of the tools, goes on at a steady pace (WorkPace). Haptic thread.
class Refinement
{
public:
    /// Where tools are meshes others ask how near their surface is, so trees are refitted at once.
    explicit Refinement(bool has_meshes) noexcept : has_meshes_(has_meshes) {}

    /// Returns the most urgent class of the pairs that found no room for a face, kUrgencyClasses
    /// where all did.
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
    bool had_no_room_{false}; ///< The last frame, for something that it wanted.
    RefineRequests requests_; ///< In the order of their pairs.
    RefineRequests by_model_; ///< The same, model by model.
    /// How a request was served last in this frame.
    struct Service
    {
        SplitLimits limits;      ///< Splits that the frame might have done after it,
        std::uint32_t splits{0}; ///< and that it had done.
        FrameFault found{FrameFault::none};
    };
    std::array<Service, kMaxRequests> services_{};
};

} // namespace tactus
