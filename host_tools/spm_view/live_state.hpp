// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/dds/front.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::view
{

using FrontPointer = std::shared_ptr<const dds::SeenFront>;

/// Newest known state of one object.
struct SeenObject
{
    RefinementStateObject object;
    ContentHash model{};
    std::string name{}; ///< Name in a recording; empty for live data.

    bool operator==(const SeenObject&) const = default;
};

/// Present state of one controller.
struct LiveController
{
    dds::WatchedController told;
    FrontPointer front;              ///< Refinement state; null if none was received.
    std::vector<SeenObject> objects; ///< Objects, ascending by their number on the controller.
    /// The same objects as telemetry reports them, more often; empty for a recording.
    std::vector<ObjectTelemetry> shown;
    /// True for a recording, which lacks times, deadlines and the causes of fades.
    bool is_recorded{false};
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
    static constexpr std::size_t kFronts = 600;
    /// Maximum bytes of all stored refinement states. Those being read take memory in addition.
    static constexpr std::size_t kFrontBytes = std::size_t{64} << 20U;

    /// Publishes a snapshot if the data changed. Only the thread that receives DDS data may call
    /// it.
    void publish(const std::vector<dds::WatchedController>& told,
                 const std::vector<dds::SeenFront>& fronts);

    /// The newest snapshot; never null.
    [[nodiscard]] std::shared_ptr<const Snapshot> newest() const;
    /// Waits at most `patience` for a snapshot with a serial above `seen`; returns the newest one.
    [[nodiscard]] std::shared_ptr<const Snapshot>
    wait_newer(std::uint64_t seen, std::chrono::milliseconds patience) const;

    /// Stored refinement state of a controller by its serial; null if it is not stored.
    [[nodiscard]] FrontPointer front(const std::string& controller, std::uint64_t serial) const;

private:
    struct Kept
    {
        std::deque<FrontPointer> fronts;
        std::size_t bytes{0};
        std::map<std::uint32_t, SeenObject> objects;
    };

    static void add_objects(Kept& kept, const RefinementState& front);
    /// True if the controllers or their data changed since the last snapshot.
    [[nodiscard]] bool is_news(const std::vector<dds::WatchedController>& told,
                               const std::vector<dds::SeenFront>& fronts) const;
    void keep(const dds::SeenFront& front);

    mutable std::mutex mutex_;
    mutable std::condition_variable news_;
    std::shared_ptr<const Snapshot> snapshot_{std::make_shared<Snapshot>()};
    std::map<dds::ControllerId, Kept> kept_;
    /// Objects of each controller in its telemetry, by their number on the controller.
    std::map<dds::ControllerId, std::map<std::uint32_t, ObjectTelemetry>> shown_;
};

/// Text of a controller's id in hexadecimal digits.
[[nodiscard]] std::string id_text(const dds::ControllerId& id);

} // namespace tactus::view
