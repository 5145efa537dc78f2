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

/// Counts of an object's poses.
struct PoseCounts
{
    std::uint64_t accepted{0};
    std::array<std::uint64_t, kPoseRefusals> refused{}; ///< Counts in the order of PoseRefusal.

    [[nodiscard]] std::uint64_t refused_in_all() const noexcept;
};

/// An object as its server shows it at present.
struct SeenObject
{
    std::uint64_t host_epoch{0};
    std::uint32_t number{0}; ///< Number on that server.
    std::uint32_t generation{0};
    ShownObject shown; ///< Object; its pose has a rotation of length 1.
    std::uint64_t serial{0};
    std::int64_t host_time_ns{0}; ///< Server time of the pose; 0: the pose came with the object.
    PoseCounts counts;
};

enum class SceneNews : std::uint8_t
{
    comes,
    moves,
    feels, ///< The material changed.
    goes,
};

/// The controller's side of objects: those of the servers that it follows, checked. A server admits
/// a few controllers at a time, so the objects arrive a little later than the server is followed.
/// Outdated and invalid poses are counted and ignored. An object of a model that its server lacks
/// is hidden until the server has it. The objects of a server that is gone stay as they are; when
/// it returns, those it no longer shows are removed. One thread, that of the exchange; no call
/// waits.
class SceneReader
{
public:
    /// `domain` and `exchange` must outlive the reader. `log` gets, at a limited rate, a line for
    /// each object of a model that its server lacks for two seconds.
    SceneReader(const Domain& domain, PieceExchange& exchange, Log log = {})
        : domain_(domain), exchange_(exchange), log_(std::move(log))
    {
    }

    /// Follows exactly these servers and reports changes of their objects to `take`, which must not
    /// be empty; its argument is valid during the call. An object that is replaced under its number
    /// is removed and added. Bounded.
    void poll(std::span<const std::uint64_t> hosts,
              const std::function<void(SceneNews, const SeenObject&)>& take);

    /// True if the server was heard in the last poll: its objects are as last reported.
    [[nodiscard]] bool was_heard(std::uint64_t host_epoch) const;
    /// True if all objects that the server shows have arrived.
    [[nodiscard]] bool is_complete(std::uint64_t host_epoch) const;

    /// Objects by number, valid until the next poll(); empty for a server that is not followed.
    [[nodiscard]] const std::map<std::uint32_t, SeenObject>&
    objects(std::uint64_t host_epoch) const;

    /// Number of times that motion from a present server was lost and then received from another
    /// writer.
    [[nodiscard]] std::uint64_t motion_regained() const noexcept { return motion_regained_; }

    /// Servers whose objects cannot be read, one line each, as of the last poll.
    [[nodiscard]] const std::string& fault() const noexcept { return fault_; }

private:
    using Clock = std::chrono::steady_clock;
    using Take = std::function<void(SceneNews, const SeenObject&)>;
    /// An object of a model that its server lacks.
    struct Stranger
    {
        SeenObject object;
        Clock::time_point since{};
        bool is_told{false};
    };
    struct Host
    {
        Endpoint records; ///< Valid once the server has admitted the controller.
        Endpoint motion;
        std::map<std::uint32_t, SeenObject> objects;
        /// Strangers by number; none of them is in `objects`.
        std::map<std::uint32_t, Stranger> strangers;
        /// Objects that a program, perhaps another one, ended, and the time of that.
        std::map<std::uint32_t, Clock::time_point> disputed;
        /// Objects from before the server was gone, not confirmed since its return.
        std::set<std::uint32_t> unconfirmed;
        std::uint64_t seen_catalogue{0};
        bool was_heard{false};
        bool is_complete{false};
        bool is_gone{false};
        Clock::time_point since{};
        /// Time of its last motion, or of the subscription to it.
        Clock::time_point heard{};
        std::uint64_t motion_writer{0}; ///< Handle of the writer of motion that was heard last.
        std::uint64_t motion_serial{0}; ///< Highest serial number from that writer.

        /// Number of objects that the server has described so far.
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
