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

/// An object where it was last seen.
struct SeenObject
{
    FrontObject object;
    ContentHash model{};
    std::string name{}; ///< Its own, of a recording; may be empty.

    bool operator==(const SeenObject&) const = default;
};

/// One controller as it is now.
struct LiveController
{
    dds::WatchedController told;
    FrontPointer front;              ///< Null: it shows none.
    std::vector<SeenObject> objects; ///< By their numbers on the controller.
    /// Of a recording: nothing is known of times, deadlines and of why a force was withheld.
    bool is_recorded{false};
};

/// All that is known of the controllers at one moment.
struct Snapshot
{
    std::uint64_t serial{1}; ///< Grows by one each time there is news.
    std::vector<LiveController> controllers;

    /// By its id in hexadecimal digits, or the first one where `id` is empty; null when not there.
    [[nodiscard]] const LiveController* find(const std::string& id) const;
};

/// Between the thread that hears DDS and those that answer the browser: the newest snapshot, and
/// the fronts of the last minute. Any thread.
class LiveState
{
public:
    /// Fronts that are kept of one controller: a minute's.
    static constexpr std::size_t kFronts = 600;
    /// Bytes that all kept fronts may take, some more while they are read.
    static constexpr std::size_t kFrontBytes = std::size_t{64} << 20U;

    /// The one thread that hears DDS.
    void publish(const std::vector<dds::WatchedController>& told,
                 const std::vector<dds::SeenFront>& fronts);

    /// Never null.
    [[nodiscard]] std::shared_ptr<const Snapshot> newest() const;
    /// The newest one once it is newer than `seen`, or after `patience` whatever there is.
    [[nodiscard]] std::shared_ptr<const Snapshot>
    wait_newer(std::uint64_t seen, std::chrono::milliseconds patience) const;

    /// A front of the last minute; null when it isn't kept.
    [[nodiscard]] FrontPointer front(const std::string& controller, std::uint64_t serial) const;

private:
    struct Kept
    {
        std::deque<FrontPointer> fronts;
        std::size_t bytes{0};
        std::map<std::uint32_t, SeenObject> objects;
    };

    static void add_objects(Kept& kept, const Front& front);
    /// Whether anything came, or anybody went, since the last snapshot.
    [[nodiscard]] bool is_news(const std::vector<dds::WatchedController>& told,
                               const std::vector<dds::SeenFront>& fronts) const;
    void keep(const dds::SeenFront& front);

    mutable std::mutex mutex_;
    mutable std::condition_variable news_;
    std::shared_ptr<const Snapshot> snapshot_{std::make_shared<Snapshot>()};
    std::map<dds::ControllerId, Kept> kept_;
};

/// A controller's id in hexadecimal digits.
[[nodiscard]] std::string id_text(const dds::ControllerId& id);

} // namespace tactus::view
