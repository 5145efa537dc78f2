// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/edit_content.hpp"
#include "transport/edit_request.hpp"
#include "transport/edit_state.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct tactus_v5_EditRequests; // idlc's type of a sample.

namespace tactus::dds
{

/// Usual room of a model for added faces.
inline constexpr std::uint32_t kUsualEditRoom = 4'096;

/// Controllers whose edit requests a server takes: all, or those that Participants::is_called()
/// finds. With DDS Security, only participants with the right reach the topic.
struct Editors
{
    bool all{false};
    std::vector<std::string> names;
};

/// Publishes edits of a server's models, and takes the requests of controllers. Owned and stepped
/// by DdsServer. One thread. A write waits up to 5 ms if readers do not take samples.
///
/// A controller that joins gets the sum of all edits so far. The sum is written again after
/// kKeptEdits edits, and after two seconds without one.
class EditPublisher
{
public:
    struct Counters
    {
        std::uint64_t edits{0};            ///< Published edits.
        std::uint64_t bytes{0};            ///< Bytes of their payload and of all sums.
        std::uint64_t sums{0};             ///< Sums written.
        std::uint64_t requests{0};         ///< Accepted requests.
        std::uint64_t requests_refused{0}; ///< Refused requests.
    };
    /// A model by its number on the server. `header` is a view whose bytes must outlive the
    /// publisher.
    struct Model
    {
        ModelHeader header;
        std::uint32_t room{0}; ///< Slots for added faces; 0: the model can't be edited.
    };

    /// `domain` must outlive the publisher.
    [[nodiscard]] static Result<std::unique_ptr<EditPublisher>, Refusal>
    create(const Domain& domain, std::vector<Model> models, Editors editors);

    /// Publishes edits of the model with this number, in order. The first edit that can't follow is
    /// refused, and those behind it are not looked at; the ones before it are published.
    [[nodiscard]] std::optional<Refusal> publish(std::uint32_t model,
                                                 std::span<const EditContent> edits);
    /// The next request in order of arrival; none if there is none. The order is the same for all:
    /// that of the calls.
    [[nodiscard]] std::optional<EditRequest> take();

    /// Writes sums that are due. Takes 0.1 us or less if none is.
    void step();

    /// Surface of a model; null if it can't be edited.
    [[nodiscard]] const EditState* state(std::uint32_t model) const;
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    /// DDS handle of the reader of requests, for a waitset.
    [[nodiscard]] std::int32_t requests_handle() const noexcept { return requests_.handle; }

private:
    using Clock = std::chrono::steady_clock;
    struct Edited
    {
        Model model;
        EditState state;
        std::uint32_t sum_to{0}; ///< Revision of the last sum that was written completely.
        bool owes_sum{true};     ///< True if a sample could not be written.
        Clock::time_point last_edit{};
    };

    EditPublisher(const Domain& domain, std::vector<Model> models, Editors editors);

    [[nodiscard]] bool try_write(std::uint32_t model, std::uint32_t index, std::uint32_t from,
                                 std::uint32_t to, std::uint32_t part, std::uint32_t parts);
    void write_sum(std::uint32_t model);
    void read_requests();
    [[nodiscard]] bool may_edit(const ControllerId& controller) const;

    const Domain* domain_;
    Editors editors_;
    std::vector<Edited> models_;
    Endpoint edits_;
    Endpoint requests_;
    std::vector<std::byte> coded_;
    std::deque<EditRequest> waiting_;
    Counters counters_;
};

/// Request in a sample, with rotations of length 1; none if it is not sound (is_sound()).
[[nodiscard]] std::optional<EditRequest> request_from(const tactus_v5_EditRequests& wire);

/// Number of parts of the largest sum of such a model's edits, at most kMaxSumParts.
[[nodiscard]] std::uint32_t most_sum_parts(const ModelCounts& counts, std::uint32_t room) noexcept;

} // namespace tactus::dds
