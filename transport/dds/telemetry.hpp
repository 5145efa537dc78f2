// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/model_identity.hpp"
#include "transport/refinement_state.hpp"
#include "transport/telemetry.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct dds_sample_info;
struct tactus_v5_Telemetry; // idlc's type of a sample.

namespace tactus::dds
{

/// Maximum number of controllers of one TelemetryReader; samples of others are refused.
inline constexpr std::size_t kMaxWatched = 256;

/// Publishes a controller's telemetry. One thread, the transport thread.
class TelemetryWriter
{
public:
    /// `domain` must outlive the writer. `controller_name` must be valid, and `models` name the
    /// models of Telemetry::models, in order and at most kMaxShownModels (both asserted).
    [[nodiscard]] static Result<std::unique_ptr<TelemetryWriter>, Refusal>
    create(const Domain& domain, std::string controller_name, std::vector<ModelIdentity> models);

    /// Sends a sample to all readers; never waits. `telemetry.model_count` must equal the number of
    /// models, its counts of tools and pairs must fit their arrays, and there may be at most
    /// kMaxShownObjects objects (asserted). `state` may be null; it must keep the limits of
    /// transport/refinement_state.hpp (asserted).
    void write(const Telemetry& telemetry, const ObjectsTelemetry& objects = {},
               const RefinementState* state = nullptr);

    /// True if there is a reader.
    [[nodiscard]] bool is_watched() const { return is_matched(writer_); }
    /// True if there is a reader of refinement states.
    [[nodiscard]] bool wants_states() const { return has_reader_of_states(writer_); }

    /// Number of samples sent.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
    /// Number of these samples that had a refinement state.
    [[nodiscard]] std::uint64_t states_sent() const noexcept { return states_sent_; }

private:
    TelemetryWriter(const ControllerId& controller, std::string controller_name,
                    std::vector<ModelIdentity> models);

    ControllerId controller_;
    std::string controller_name_;
    std::vector<ModelIdentity> models_;
    Endpoint writer_;
    std::uint64_t sent_{0};
    std::uint64_t states_sent_{0};
};

/// Refinement state of a controller, and the serial of the sample that had it.
struct SeenState
{
    std::uint64_t serial{0};
    RefinementState state;
};

/// Newest telemetry of one controller.
struct WatchedController
{
    ControllerId id{};
    std::string name; ///< Valid name of the controller.
    std::uint64_t serial{0};
    std::vector<ModelIdentity> models; ///< Identities of Telemetry::models, in order.
    Telemetry telemetry;
    ObjectsTelemetry objects;
    std::shared_ptr<const SeenState> state; ///< Newest refinement state; null if there was none.
    std::uint64_t writer{0};                ///< DDS handle of the writer of the last sample.
    /// True if any program ended this controller's instance in DDS; poll() then checks its writer.
    bool is_disputed{false};
};

/// Telemetry in a sample, without `writer` and `is_disputed`; none if a name is invalid, a number
/// impossible, a count too large, or the refinement state inconsistent.
[[nodiscard]] std::optional<WatchedController> watched_from(const tactus_v5_Telemetry& sample);

/// Reads the newest telemetry of each controller on a domain. One thread.
class TelemetryReader
{
public:
    /// `domain` must outlive the reader. Controllers send refinement states while there is a reader
    /// with `wants_states`, which must poll every 100 ms or states may be lost.
    [[nodiscard]] static Result<std::unique_ptr<TelemetryReader>, Refusal>
    create(const Domain& domain, bool wants_states = false);

    /// Takes new samples, and removes controllers that left or were silent for 500 ms. Bounded,
    /// never waits.
    void poll();

    /// Controllers in the order of discovery, at most kMaxWatched. Valid until the next poll().
    [[nodiscard]] const std::vector<WatchedController>& controllers() const noexcept
    {
        return controllers_;
    }
    /// Number of refused samples: see watched_from(), or of controllers beyond kMaxWatched.
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

private:
    TelemetryReader(Participants& participants, Endpoint reader);

    [[nodiscard]] bool try_take(const tactus_v5_Telemetry& sample, const dds_sample_info& info);
    void end(const ControllerId& controller, std::uint64_t writer);

    Participants& participants_;
    Endpoint reader_;
    std::vector<WatchedController> controllers_;
    std::uint64_t refused_{0};
};

} // namespace tactus::dds
