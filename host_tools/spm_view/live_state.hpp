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

/// An object and its last known pose.
struct SeenObject
{
    RefinementStateObject object;
    ContentHash model{};
    std::string name{}; ///< Name in a recording; may be empty.

    bool operator==(const SeenObject&) const = default;
};

/// Present state of one controller.
struct LiveController
{
    dds::WatchedController told;
    FrontPointer front;              ///< Refinement state; null: not published.
    std::vector<SeenObject> objects; ///< Objects by their numbers on the controller.
    /// True for a recording, which has no times, no deadlines and no reasons for withheld forces.
    bool is_recorded{false};
};

/// State of all controllers at one moment.
struct Snapshot
{
    std::uint64_t serial{1}; ///< Serial number; increases by one with each change.
    std::vector<LiveController> controllers;

    /// Controller with this id in hexadecimal digits, or the first one if `id` is empty; null if it
    /// is missing.
    [[nodiscard]] const LiveController* find(const std::string& id) const;
};

/// State shared by the thread that receives DDS data and those that answer the browser: the newest
/// snapshot, and the refinement states of the last minute. Any thread.
class LiveState
{
public:
    /// Maximum number of stored refinement states of one controller: a minute's.
    static constexpr std::size_t kFronts = 600;
    /// Maximum bytes of all stored refinement states; a few more while they are read.
    static constexpr std::size_t kFrontBytes = std::size_t{64} << 20U;

    /// Publishes a snapshot. Only for the thread that receives DDS data.
    void publish(const std::vector<dds::WatchedController>& told,
                 const std::vector<dds::SeenFront>& fronts);

    /// The newest snapshot; never null.
    [[nodiscard]] std::shared_ptr<const Snapshot> newest() const;
    /// The newest snapshot as soon as it is newer than `seen`; after `patience` in any case.
    [[nodiscard]] std::shared_ptr<const Snapshot>
    wait_newer(std::uint64_t seen, std::chrono::milliseconds patience) const;

    /// A refinement state of the last minute; null if it is not stored.
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
};

/// Text of a controller's id in hexadecimal digits.
[[nodiscard]] std::string id_text(const dds::ControllerId& id);

} // namespace tactus::view
