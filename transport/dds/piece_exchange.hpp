// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/credit.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/request_queue.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/writer_lanes.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Silence after which other servers with the same model are asked, and how many at the same time:
/// most may be unknown participants that never answer.
inline constexpr std::chrono::milliseconds kSilence{300};
inline constexpr std::size_t kHostsAtOnce = 64;

/// Receives the pieces of one model. The bytes are not verified, and valid only during the call.
class PieceReceiver
{
public:
    [[nodiscard]] virtual const ContentHash& model() const = 0;
    virtual void receive(std::uint64_t host_epoch, ContentKey key,
                         std::span<const std::byte> bytes) = 0;

protected:
    ~PieceReceiver() = default;
};

/// A controller's requests and pieces, for all its models and servers: one pair of endpoints, and a
/// credit for each server. One thread; no call waits.
class PieceExchange
{
public:
    /// `domain` and `catalogue` must outlive the exchange. `controller_name` must be valid.
    [[nodiscard]] static Result<std::unique_ptr<PieceExchange>, Refusal>
    create(const Domain& domain, Catalogue& catalogue, std::string controller_name);

    /// Sends the pieces of its model to the receiver until remove().
    void add(PieceReceiver& receiver) { receivers_.push_back(&receiver); }
    void remove(PieceReceiver& receiver) { std::erase(receivers_, &receiver); }

    /// Announces the controller to the server before the first request.
    void meet(std::uint64_t host_epoch) { static_cast<void>(host_of(host_epoch)); }

    /// Requests pieces of one of a server's models, highest priority first; they are sent with the
    /// next step(). A newer generation goes before requests that still wait.
    void ask(std::uint64_t host_epoch, std::uint32_t model, std::span<const ContentKey> keys,
             std::uint32_t generation);

    /// Requests the server's objects. The server admits the controller when they may be read;
    /// is_let_in() reports that.
    void ask_for_objects(std::uint64_t host_epoch);
    [[nodiscard]] bool is_let_in(std::uint64_t host_epoch) const;
    /// Reports to the server that the objects have arrived, so that it admits the next controller.
    /// If `hears_motion` is false, requests another writer of motion: a forged packet can make
    /// readers ignore a writer.
    void tell_objects_are_here(std::uint64_t host_epoch, bool hears_motion);
    /// Withdraws the request for objects. A later request waits for admission again.
    void leave_objects(std::uint64_t host_epoch);

    /// Refreshes the catalogue, delivers received pieces, sends requests and signs of life that are
    /// due.
    void step();
    /// Models served as of the last step().
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    /// Number of calls of step().
    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Objects : std::uint8_t // Values of tactus_v5_Wanted::objects.
    {
        not_wanted,
        waits,
        are_here,
        hear_no_motion,
    };
    struct Host
    {
        std::uint64_t epoch{0};
        CreditWindow credit{kCreditPieces};
        std::vector<HostPiece> requests;
        std::uint32_t generation{0};
        std::uint64_t granted_sent{0}; ///< Count in the last request to the server.
        std::uint32_t write_offs{0};   ///< Write-offs since the last sample.
        bool awaits_pieces{false};     ///< True if there was a request since the last sample.
        bool is_let_in{false};
        Objects objects{Objects::not_wanted};
        Clock::time_point last_sent{};
        Clock::time_point last_progress{};
    };

    PieceExchange(const Domain& domain, Catalogue& catalogue, std::string controller_name);

    [[nodiscard]] Host* find(std::uint64_t epoch);
    [[nodiscard]] Host& host_of(std::uint64_t epoch);
    void forget_hosts();
    void take_pieces();
    void hand_over(std::span<const std::byte> payload, Host& host, std::uint64_t sent);
    void keep_credit(Host& host);
    void send(Host& host);

    Catalogue& catalogue_;
    std::string controller_name_;
    ControllerId controller_;
    std::unique_ptr<WriterLanes> wanted_; ///< Valid after create().
    /// Writers before the last renewal: servers may identify this controller by them.
    std::shared_ptr<void> old_wanted_;
    Endpoint chunks_;
    std::vector<PieceReceiver*> receivers_;
    std::vector<Host> hosts_;
    std::uint64_t seen_catalogue_{0};
    std::uint64_t steps_{0};
};

} // namespace tactus::dds
