// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/handshake_watch.hpp"
#include "transport/dds/request_queue.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/writer_lanes.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Controller's side of the flow control of pieces from one server (one epoch).
///
/// The server sends in each sample the number of pieces `sent` so far, and stops at `granted`. The
/// controller grants a window beyond `seen`, the largest number it received. All numbers are
/// totals, so the next sample repairs the loss of one. Only the loss of a whole window stops the
/// flow; then write_off() treats it as seen.
class CreditWindow
{
public:
    explicit CreditWindow(std::uint64_t window) noexcept : window_(window) {}

    /// Records a sample that states the total `sent` and holds `pieces` pieces.
    void on_sample(std::uint64_t sent, std::uint64_t pieces) noexcept
    {
        seen_ = std::max(seen_, sent);
        received_ += pieces;
    }

    /// Treats all granted pieces as lost; for use after a long silence.
    void write_off() noexcept { seen_ = granted(); }

    [[nodiscard]] std::uint64_t seen() const noexcept { return seen_; }
    [[nodiscard]] std::uint64_t granted() const noexcept { return seen_ + window_; }
    [[nodiscard]] std::uint64_t received() const noexcept { return received_; }

private:
    std::uint64_t window_;
    std::uint64_t seen_{0};
    std::uint64_t received_{0};
};

/// Time without a piece after which other servers with the model are asked, and the maximum number
/// asked at the same time: most of them may be unknown participants that never answer.
inline constexpr std::chrono::milliseconds kSilence{300};
inline constexpr std::size_t kServersAtOnce = 64;

/// Receives the pieces of one model. `bytes` are unverified, and valid only during the call.
class PieceReceiver
{
public:
    [[nodiscard]] virtual const ContentHash& model() const = 0;
    virtual void receive(std::uint64_t server_epoch, ContentKey key,
                         std::span<const std::byte> bytes) = 0;

protected:
    ~PieceReceiver() = default;
};

/// Sends a controller's requests and receives its pieces, for all models and servers; keeps a
/// CreditWindow for each server. One thread; no call waits.
class PieceExchange
{
public:
    /// `domain` and `catalogue` must outlive the exchange. `controller_name` must be valid.
    [[nodiscard]] static Result<std::unique_ptr<PieceExchange>, Refusal>
    create(const Domain& domain, Catalogue& catalogue, std::string controller_name);

    /// Delivers the pieces of receiver.model() to the receiver until remove().
    void add(PieceReceiver& receiver) { receivers_.push_back(&receiver); }
    void remove(PieceReceiver& receiver) { std::erase(receivers_, &receiver); }

    /// Makes the server known, so that the next step() announces the controller to it.
    void announce_to(std::uint64_t server_epoch) { static_cast<void>(server_of(server_epoch)); }

    /// Queues requests for pieces of model number `model` on a server, highest priority first;
    /// step() sends them. Pieces of a newer generation are sent before waiting ones of older
    /// generations.
    void ask(std::uint64_t server_epoch, std::uint32_t model, std::span<const ContentKey> keys,
             std::uint32_t generation);

    /// Requests the objects of a server. is_admitted() is true once the server has admitted the
    /// controller, which may then read them.
    void ask_for_objects(std::uint64_t server_epoch);
    [[nodiscard]] bool is_admitted(std::uint64_t server_epoch) const;
    /// Reports to the server that the objects have arrived, so that it admits the next controller.
    /// `hears_motion` false requests a new writer of motion, since a forged packet can make readers
    /// ignore a writer.
    void report_objects_received(std::uint64_t server_epoch, bool hears_motion);
    /// Withdraws the request for objects. A later request needs a new admission.
    void leave_objects(std::uint64_t server_epoch);

    /// Refreshes the catalogue, delivers received pieces, and sends requests and, if due, signs of
    /// life.
    void step();
    /// Models and servers as of the last step().
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    /// Number of calls of step().
    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Objects : std::uint8_t // In the order of the values of tactus_v5_Wanted::objects.
    {
        not_wanted,
        waits,
        are_here,
        hear_no_motion,
    };
    struct Server
    {
        std::uint64_t epoch{0};
        CreditWindow credit{kCreditPieces};
        std::vector<ServerPiece> requests;
        std::uint32_t generation{0};
        std::uint64_t granted_sent{0}; ///< Value of `granted` last sent to the server.
        std::uint32_t write_offs{0};   ///< Number of write-offs since the last piece.
        bool awaits_pieces{false};     ///< True if pieces were requested since the last sample.
        bool is_admitted{false};
        Objects objects{Objects::not_wanted};
        Clock::time_point last_sent{};
        Clock::time_point last_progress{};
    };

    PieceExchange(const Domain& domain, Catalogue& catalogue, std::string controller_name);

    [[nodiscard]] Server* find(std::uint64_t epoch);
    [[nodiscard]] Server& server_of(std::uint64_t epoch);
    void watch_handshakes();
    void forget_servers();
    void take_pieces();
    void hand_over(std::span<const std::byte> payload, Server& server, std::uint64_t sent);
    void keep_credit(Server& server);
    void send(Server& server);

    const Domain& domain_;
    Catalogue& catalogue_;
    std::string controller_name_;
    ControllerId controller_;
    std::unique_ptr<WriterLanes> wanted_; ///< Valid after create().
    /// Writers before the last renewal, kept since servers may know this controller by them.
    std::shared_ptr<void> old_wanted_;
    Endpoint chunks_;
    std::vector<PieceReceiver*> receivers_;
    std::vector<Server> servers_;
    std::uint64_t seen_catalogue_{0};
    std::uint64_t steps_{0};
    std::set<std::string> certificates_; ///< Certificates of connected servers, now or before.
    HandshakeWatch handshakes_;
    Clock::time_point next_watch_{};
};

} // namespace tactus::dds
