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

/// Number of accepted and refused poses of one object.
struct PoseCounts
{
    std::uint64_t accepted{0};
    std::array<std::uint64_t, kPoseRefusals> refused{}; ///< Counts in the order of PoseRefusal.

    [[nodiscard]] std::uint64_t refused_in_all() const noexcept;
};

/// An object and its newest state from its server.
struct SeenObject
{
    std::uint64_t server_epoch{0};
    std::uint32_t number{0}; ///< Number of the object on that server.
    std::uint32_t generation{0};
    ShownObject shown; ///< Name, model, material and pose; the rotation has length 1.
    std::uint64_t serial{0};
    /// Server time of the pose; 0 for the pose in the object's record.
    std::int64_t server_time_ns{0};
    PoseCounts counts;
};

/// Object in a record, without its pose and serial number; refused for an invalid name or material.
[[nodiscard]] Result<SeenObject, Refused> object_from(const tactus_v5_ObjectRecord& record);

enum class SceneNews : std::uint8_t
{
    comes,
    moves,
    feels, ///< The material changed.
    goes,
};

/// Receives and checks the objects of the servers that a controller follows. A server admits a few
/// controllers at a time, so its objects arrive with a delay. Invalid and old poses are counted and
/// ignored. An object is hidden while its server does not serve its model. Objects of a server that
/// is gone stay; after its return those that it no longer shows are removed. One thread, that of
/// the exchange; no call waits.
class SceneReader
{
public:
    /// `domain` and `exchange` must outlive the reader. `log` gets, at a limited rate, a line for
    /// each object whose server has not served its model for two seconds.
    SceneReader(const Domain& domain, PieceExchange& exchange, Log log = {})
        : domain_(domain), exchange_(exchange), log_(std::move(log))
    {
    }

    /// Follows exactly these servers, and calls `take`, which must not be empty, for each change of
    /// their objects; the SeenObject is valid during the call. A new object under a used number is
    /// reported as a removal and an addition. Bounded.
    void poll(std::span<const std::uint64_t> servers,
              const std::function<void(SceneNews, const SeenObject&)>& take);

    /// True if the last poll received new motion of the server, so its objects are up to date.
    [[nodiscard]] bool was_heard(std::uint64_t server_epoch) const;
    /// True if all objects of the server have arrived, or two seconds have passed since the
    /// admission.
    [[nodiscard]] bool is_complete(std::uint64_t server_epoch) const;

    /// Objects of a server by number, valid until the next poll(); empty if it is not followed.
    [[nodiscard]] const std::map<std::uint32_t, SeenObject>&
    objects(std::uint64_t server_epoch) const;

    /// Number of times that motion of a server was lost for 300 ms and then received from another
    /// writer.
    [[nodiscard]] std::uint64_t motion_regained() const noexcept { return motion_regained_; }

    /// Reason why the objects of a server could last not be read; empty if that never happened.
    [[nodiscard]] const std::string& fault() const noexcept { return fault_; }

private:
    using Clock = std::chrono::steady_clock;
    using Take = std::function<void(SceneNews, const SeenObject&)>;
    /// An object whose server does not serve its model; not reported to `take`.
    struct Stranger
    {
        SeenObject object;
        Clock::time_point since{};
        bool is_told{false};
    };
    struct Server
    {
        Endpoint records; ///< Valid once the server has admitted the controller.
        Endpoint motion;
        std::map<std::uint32_t, SeenObject> objects;
        /// Strangers by number; the numbers differ from those in `objects`.
        std::map<std::uint32_t, Stranger> strangers;
        /// Objects whose instance any program ended in DDS, with the time of that.
        std::map<std::uint32_t, Clock::time_point> disputed;
        /// Objects from before the server's absence that it has not shown since its return.
        std::set<std::uint32_t> unconfirmed;
        std::uint64_t seen_catalogue{0};
        bool was_heard{false};
        bool is_complete{false};
        bool is_gone{false};
        Clock::time_point since{};
        /// Time of the last new motion; before any, of the subscription.
        Clock::time_point heard{};
        /// DDS handle of the writer of the last new motion; 0: none.
        std::uint64_t motion_writer{0};
        std::uint64_t motion_serial{0}; ///< Highest serial number from that writer.

        /// Number of objects that the server has described so far.
        [[nodiscard]] std::size_t known() const
        {
            return objects.size() - unconfirmed.size() + strangers.size();
        }
    };

    void join(std::uint64_t epoch, Server& server);
    void watch(std::uint64_t epoch, Server& server);
    static void drop_unconfirmed(Server& server, const Take& take);
    void take_records(std::uint64_t epoch, Server& server, const Take& take);
    [[nodiscard]] std::optional<Refused>
    take_record(Server& server, const tactus_v5_ObjectRecord& record, const Take& take);
    void take_motion(std::uint64_t epoch, Server& server, const Take& take);
    static void begin_with(Server& server, std::uint64_t writer);
    void note_motion(std::uint64_t epoch, Server& server, std::uint64_t writer);
    static void settle_disputed(Server& server, std::uint32_t objects, const Take& take);
    void check_strangers(std::uint64_t epoch, Server& server, const Take& take);
    static bool try_move(SeenObject& object, std::uint64_t serial, const tactus_v5_Placement& to);
    static void remove(Server& server, std::uint32_t number, const Take& take);

    const Domain& domain_;
    PieceExchange& exchange_;
    RateLimitedLog log_;
    std::map<std::uint64_t, Server> servers_;
    std::uint64_t motion_regained_{0};
    std::string fault_;
};

} // namespace tactus::dds
