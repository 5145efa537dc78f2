// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/front.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct tactus_v5_RefinementState; // idlc's type of a sample.

namespace tactus::dds
{

/// Publishes a controller's refinement state. One thread, the transport thread.
class RefinementStateWriter
{
public:
    /// `domain` must outlive the writer; `controller_name` is valid (asserted).
    [[nodiscard]] static Result<std::unique_ptr<RefinementStateWriter>, Refusal>
    create(const Domain& domain, std::string controller_name);

    /// Sends a refinement state to all readers; never waits. The state must keep the limits of
    /// transport/front.hpp, and its objects must refer to its models (asserted).
    void write(const RefinementState& front);

    /// True if there is a reader.
    [[nodiscard]] bool is_watched() const { return is_matched(writer_); }

    /// Number of samples sent.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

private:
    RefinementStateWriter(const ControllerId& controller, std::string controller_name);

    ControllerId controller_;
    std::string controller_name_;
    Endpoint writer_;
    std::uint64_t sent_{0};
};

/// Newest refinement state of one controller.
struct SeenFront
{
    ControllerId id{};
    std::uint64_t serial{0};
    RefinementState front;
    std::uint64_t writer{0}; ///< DDS handle of the writer of the last sample.
    /// True if any program ended this controller's instance in DDS; poll() then checks its writer.
    bool is_disputed{false};
};

/// Refinement state in a sample, without `writer` and `is_disputed`; none if its counts do not add
/// up, its chunks do not ascend, or a name or a number is out of range.
[[nodiscard]] std::optional<SeenFront> front_from(const tactus_v5_RefinementState& sample);

/// Reads the newest refinement state of each controller on a domain. One thread.
class RefinementStateReader
{
public:
    /// Maximum number of controllers; samples of others are refused.
    static constexpr std::size_t kMaxSeen = 64;

    /// `domain` must outlive the reader.
    [[nodiscard]] static Result<std::unique_ptr<RefinementStateReader>, Refusal>
    create(const Domain& domain);

    /// Takes new samples, and removes controllers that left or were silent for 500 ms. Bounded,
    /// never waits.
    void poll();

    /// States in the order of discovery of their controllers. Valid until the next poll().
    [[nodiscard]] const std::vector<SeenFront>& fronts() const noexcept { return fronts_; }
    /// Number of refused samples: inconsistent, with numbers out of range, or of controllers beyond
    /// kMaxSeen.
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

private:
    RefinementStateReader(Participants& participants, Endpoint reader);

    Participants& participants_;
    Endpoint reader_;
    std::vector<SeenFront> fronts_;
    std::uint64_t refused_{0};
};

} // namespace tactus::dds
