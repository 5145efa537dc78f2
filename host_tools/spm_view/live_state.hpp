// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tactus::view
{

using StatePointer = std::shared_ptr<const dds::SeenState>;

/// Present state of one controller.
struct LiveController
{
    dds::WatchedController told;
    std::vector<ObjectTelemetry> objects; ///< All objects, ascending by their number.
    /// True for a recording, which lacks times, deadlines and the causes of fades.
    bool is_recorded{false};

    /// Refinement state; null if none was received.
    [[nodiscard]] const RefinementState* state() const noexcept
    {
        return told.state != nullptr ? &told.state->state : nullptr;
    }
};

/// State of all controllers at one moment.
struct Snapshot
{
    std::uint64_t serial{1}; ///< Number of the snapshot; increases by one with each change.
    std::vector<LiveController> controllers;

    /// Controller with this id_text(); the first one if `id` is empty; null if there is none.
    [[nodiscard]] const LiveController* find(const std::string& id) const;
};

/// State shared by the thread that receives DDS data and the threads that answer browsers: the
/// newest snapshot, and the refinement states of the last minute. Any thread.
class LiveState
{
public:
    /// Maximum number of stored refinement states of one controller: 10 a second for a minute.
    static constexpr std::size_t kStates = 600;
    /// Maximum bytes of all stored refinement states. Those being read take memory in addition.
    static constexpr std::size_t kStateBytes = std::size_t{64} << 20U;

    /// Publishes a snapshot if the data changed. Only the thread that receives DDS data may call
    /// it.
    void publish(const std::vector<dds::WatchedController>& told);

    /// The newest snapshot; never null.
    [[nodiscard]] std::shared_ptr<const Snapshot> newest() const;
    /// Waits at most `patience` for a snapshot with a serial above `seen`; returns the newest one.
    [[nodiscard]] std::shared_ptr<const Snapshot>
    wait_newer(std::uint64_t seen, std::chrono::milliseconds patience) const;

    /// Stored refinement state of a controller by its serial; null if it is not stored.
    [[nodiscard]] StatePointer state(const std::string& controller, std::uint64_t serial) const;

private:
    struct Kept
    {
        std::deque<StatePointer> states;
        std::size_t bytes{0}; ///< Bytes of `states`.
        std::map<std::uint32_t, ObjectTelemetry> objects;
    };

    void keep(const dds::WatchedController& controller);

    mutable std::mutex mutex_;
    mutable std::condition_variable news_;
    std::shared_ptr<const Snapshot> snapshot_{std::make_shared<Snapshot>()};
    std::map<dds::ControllerId, Kept> kept_;
};

/// The model's part of a refinement state; without pages and requests if the state lacks it.
[[nodiscard]] RefinementStateModel model_in(const RefinementState& state, const ContentHash& hash);

/// Text of a controller's id in hexadecimal digits.
[[nodiscard]] std::string id_text(const dds::ControllerId& id);

} // namespace tactus::view
