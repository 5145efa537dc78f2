// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording.hpp"
#include "rt_core/frame/model.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tactus
{

/// The transport thread's part for one model in a replay: fills the slots that the recording names,
/// links and takes back in the recorded order, and pushes into the door what the frame took.
class ReplayDoor
{
public:
    /// All must outlive the door; `index` is the model's in the recording.
    ReplayDoor(const Recording& recording, std::uint32_t index, Model& model);

    /// Makes the door as the frame found it. Returns what doesn't fit: a frame that went another
    /// way before has freed other slots or wished for other pieces.
    [[nodiscard]] std::optional<std::string> open(const RecordedFrame::Door& door);

private:
    using Fault = std::optional<std::string>;

    [[nodiscard]] Fault arrive(const DoorEvent& event);
    [[nodiscard]] Fault update(const DoorEvent& event);
    [[nodiscard]] Fault take_back_freed(std::uint32_t freed_taken);
    [[nodiscard]] Fault fill(const DoorEvent& event);
    [[nodiscard]] Fault grant_wishes(std::uint32_t wish_room);

    const Recording& recording_;
    std::uint32_t index_;
    Model& model_;
    std::vector<ChunkId> pages_; ///< What is in each slot; none: the slot is here.
    std::vector<IndexPageId> index_pages_;
    std::set<std::uint32_t> loaded_index_; ///< Index pages that are in a slot.
    std::uint32_t freed_taken_{0};
};

} // namespace tactus
