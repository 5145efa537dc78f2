// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

class Frame;
class Recording;
struct QueueEvent;
struct RecordedFrame;

/// The transport thread's part in a replay: fills the recorded slots, links and frees in the
/// recorded order, and puts into the queues the items that the frame took.
class ReplayQueues
{
public:
    /// Both must outlive this object; `frame` must be made of the recording's setup.
    ReplayQueues(const Recording& recording, Frame& frame);

    /// Prepares the queues for the next frame. Returns a mismatch, if any: earlier frames of the
    /// replay have freed other slots or requested other pieces than in the run.
    [[nodiscard]] std::optional<std::string> open(const RecordedFrame& recorded);

private:
    using Fault = std::optional<std::string>;

    [[nodiscard]] Fault replay(const QueueEvent& event);
    [[nodiscard]] Fault arrive(const QueueEvent& event);
    [[nodiscard]] Fault update(const QueueEvent& event);
    [[nodiscard]] Fault give_back(const QueueEvent& event);
    [[nodiscard]] bool has_cells_for(const QueueEvent& event) const;
    [[nodiscard]] Fault take_back_freed(std::uint32_t freed_taken);
    [[nodiscard]] Fault fill(const QueueEvent& event);
    [[nodiscard]] Fault bring_base(const QueueEvent& event);
    [[nodiscard]] Fault grant_requests(std::uint32_t request_room);

    /// Content of a slot; `id` is none if the slot is free.
    template <typename Id>
    struct Filled
    {
        Id id{};
        std::uint32_t model{0};
    };

    const Recording& recording_;
    Frame& frame_;
    std::vector<Filled<ChunkId>> pages_;
    std::vector<Filled<IndexPageId>> index_pages_;
    /// True for models whose base mesh cells were given back, until the frame acknowledges it.
    std::vector<bool> gives_cells_back_;
    /// Model and number of each loaded index page.
    std::set<std::pair<std::uint32_t, std::uint32_t>> loaded_index_;
    std::uint32_t freed_taken_{0};
};

} // namespace tactus
