// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/dds/refusals.hpp"
#include "transport/log.hpp"
#include "transport/shown_object.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

struct tactus_v5_ObjectRecord; // idlc's types of samples.
struct tactus_v5_Motion;
struct tactus_v5_Placement;

namespace tactus::dds
{

/// What has come of an object's poses.
struct PoseCounts
{
    std::uint64_t accepted{0};
    std::array<std::uint64_t, kPoseRefusals> refused{}; ///< In the order of PoseRefusal.

    [[nodiscard]] std::uint64_t refused_in_all() const noexcept;
};

/// An object as its host shows it at present.
struct SeenObject
{
    std::uint64_t host_epoch{0};
    std::uint32_t number{0}; ///< On that host.
    std::uint32_t generation{0};
    ShownObject shown; ///< Its pose has a rotation of length 1.
    std::uint64_t serial{0};
    std::int64_t host_time_ns{0}; ///< Of the pose; 0: it came with the object.
    PoseCounts counts;
};

enum class SceneNews : std::uint8_t
{
    comes,
    moves,
    feels, ///< Otherwise than before.
    goes,
};

/// The controller's side of objects: those of the hosts that it follows, checked. A host lets in a
/// few controllers at a time, so the objects come a little later than the host is followed. What is
/// older than what is here, or no pose, is counted and passed over. An object of a model that its
/// host doesn't serve isn't there: it comes when the host serves it. The objects of a host that is
/// gone stay as they are; when it is back what it doesn't show any more goes. One thread, that of
/// the exchange; no call waits.
class SceneReader
{
public:
    /// Both must outlive it. `log` gets, at a limited rate, a line for each object of a model that
    /// its host doesn't serve within two seconds.
    SceneReader(const Domain& domain, PieceExchange& exchange, Log log = {})
        : domain_(domain), exchange_(exchange), log_(std::move(log))
    {
    }

    /// Follows these hosts and no others, and tells what has become of their objects; an object
    /// that is another one under its number goes and comes. Bounded. What `take`, not empty, gets
    /// is valid during its call.
    void poll(std::span<const std::uint64_t> hosts,
              const std::function<void(SceneNews, const SeenObject&)>& take);

    /// Whether the host was heard in the last poll: all its objects stand as they were told.
    [[nodiscard]] bool was_heard(std::uint64_t host_epoch) const;
    /// Whether all that the host shows is here.
    [[nodiscard]] bool is_complete(std::uint64_t host_epoch) const;

    /// By number, until the next poll(); empty for a host that isn't followed.
    [[nodiscard]] const std::map<std::uint32_t, SeenObject>&
    objects(std::uint64_t host_epoch) const;

    /// How often a host's motion was lost though the host was there, and came by another writer.
    [[nodiscard]] std::uint64_t motion_regained() const noexcept { return motion_regained_; }

    /// Hosts whose objects can't be read; a line each, of the last poll.
    [[nodiscard]] const std::string& fault() const noexcept { return fault_; }

private:
    using Clock = std::chrono::steady_clock;
    using Take = std::function<void(SceneNews, const SeenObject&)>;
    /// An object of a model that its host doesn't serve.
    struct Stranger
    {
        SeenObject object;
        Clock::time_point since{};
        bool is_told{false};
    };
    struct Host
    {
        Endpoint records; ///< Once it has let us in.
        Endpoint motion;
        std::map<std::uint32_t, SeenObject> objects;
        std::map<std::uint32_t, Stranger> strangers; ///< By number: none that is an object.
        /// Of which somebody said that they went, perhaps another program, and when.
        std::map<std::uint32_t, Clock::time_point> disputed;
        /// Here from before the host was gone, and not told of since it is back.
        std::set<std::uint32_t> unconfirmed;
        std::uint64_t seen_catalogue{0};
        bool was_heard{false};
        bool is_complete{false};
        bool is_gone{false};
        Clock::time_point since{};
        Clock::time_point heard{};      ///< Its motion, or that it may be.
        std::uint64_t motion_writer{0}; ///< Handle of the last one that was heard.
        std::uint64_t motion_serial{0}; ///< What it had counted up to.

        /// As far as the host has told of them.
        [[nodiscard]] std::size_t known() const
        {
            return objects.size() - unconfirmed.size() + strangers.size();
        }
    };

    void join(std::uint64_t epoch, Host& host);
    void watch(std::uint64_t epoch, Host& host);
    static void drop_unconfirmed(Host& host, const Take& take);
    void take_records(std::uint64_t epoch, Host& host, const Take& take);
    [[nodiscard]] std::optional<Refused>
    take_record(Host& host, const tactus_v5_ObjectRecord& record, const Take& take);
    void take_motion(std::uint64_t epoch, Host& host, const Take& take);
    static void begin_with(Host& host, std::uint64_t writer);
    void hear(std::uint64_t epoch, Host& host, std::uint64_t writer);
    static void settle_disputed(Host& host, std::uint32_t objects, const Take& take);
    void look_at_strangers(std::uint64_t epoch, Host& host, const Take& take);
    static bool try_move(SeenObject& object, std::uint64_t serial, const tactus_v5_Placement& to);
    static void remove(Host& host, std::uint32_t number, const Take& take);

    const Domain& domain_;
    PieceExchange& exchange_;
    RateLimitedLog log_;
    std::map<std::uint64_t, Host> hosts_;
    std::uint64_t motion_regained_{0};
    std::string fault_;
};

} // namespace tactus::dds
