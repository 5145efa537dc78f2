// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/model_identity.hpp"
#include "transport/telemetry.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Controllers that one reader keeps; news of further ones are passed over.
inline constexpr std::size_t kMaxWatched = 256;

/// The controller's side. One thread, the transport thread.
class TelemetryWriter
{
public:
    /// `domain` must outlive it; `controller_name` is valid and `models`, in the order of
    /// Telemetry::models, are at most kMaxShownModels (both asserted).
    [[nodiscard]] static Result<std::unique_ptr<TelemetryWriter>, Refusal>
    create(const Domain& domain, std::string controller_name, std::vector<ModelIdentity> models);

    /// Sends it to whoever watches; never waits. `telemetry.model_count` is that of the models,
    /// tools and pairs are within its arrays (asserted).
    void write(const Telemetry& telemetry);

    /// How many were sent.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

private:
    TelemetryWriter(const ControllerId& controller, std::string controller_name,
                    std::vector<ModelIdentity> models);

    ControllerId controller_;
    std::string controller_name_;
    std::vector<ModelIdentity> models_;
    Endpoint writer_;
    std::uint64_t sent_{0};
};

/// A controller as its last sample shows it.
struct WatchedController
{
    ControllerId id{};
    std::string name; ///< Valid.
    std::uint64_t serial{0};
    std::vector<ModelIdentity> models; ///< In the order of Telemetry::models.
    Telemetry telemetry;
    std::uint64_t writer{0}; ///< Handle of the last sample's.
    bool is_disputed{false}; ///< Somebody said that it is gone, perhaps another program.
};

/// The host's side: the controllers on a domain, each at its newest. One thread.
class TelemetryReader
{
public:
    /// `domain` must outlive it.
    [[nodiscard]] static Result<std::unique_ptr<TelemetryReader>, Refusal>
    create(const Domain& domain);

    /// Takes what has come, and forgets controllers that left or fell silent (500 ms). Bounded,
    /// never waits.
    void poll();

    /// In the order in which they were first seen; at most kMaxWatched. Until the next poll().
    [[nodiscard]] const std::vector<WatchedController>& controllers() const noexcept
    {
        return controllers_;
    }
    /// Samples with names that are none or numbers that aren't finite, and those of controllers
    /// beyond kMaxWatched.
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

private:
    TelemetryReader(Participants& participants, Endpoint reader);

    Participants& participants_;
    Endpoint reader_;
    std::vector<WatchedController> controllers_;
    std::uint64_t refused_{0};
};

} // namespace tactus::dds
