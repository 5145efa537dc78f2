// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/credit.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/wish_queue.hpp"
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

/// When nothing came of a host for so long though it was asked, others that serve the same are
/// asked, so many at the same time: most may be strangers that never answer.
inline constexpr std::chrono::milliseconds kSilence{300};
inline constexpr std::size_t kHostsAtOnce = 64;

/// Gets the pieces of one model. The bytes are not verified, and valid only during the call.
class PieceReceiver
{
public:
    [[nodiscard]] virtual const ContentHash& model() const = 0;
    virtual void receive(std::uint64_t host_epoch, ContentKey key,
                         std::span<const std::byte> bytes) = 0;

protected:
    ~PieceReceiver() = default;
};

/// A controller's side of wishes and pieces, of all its models and hosts: one pair of endpoints,
/// and a credit for each host. One thread; no call waits.
class PieceExchange
{
public:
    /// `domain` and `catalogue` must outlive it. `controller_name` is a valid one.
    [[nodiscard]] static Result<std::unique_ptr<PieceExchange>, Refusal>
    create(const Domain& domain, Catalogue& catalogue, std::string controller_name);

    /// What comes of its model goes to the receiver until it is taken out.
    void add(PieceReceiver& receiver) { receivers_.push_back(&receiver); }
    void remove(PieceReceiver& receiver) { std::erase(receivers_, &receiver); }

    /// Tells the host that we are there, though nothing is wished for yet.
    void meet(std::uint64_t host_epoch) { static_cast<void>(host_of(host_epoch)); }

    /// Wishes for pieces of one of a host's models, most urgent first; they leave with the next
    /// step(). A newer generation goes before what is still waiting.
    void ask(std::uint64_t host_epoch, std::uint32_t model, std::span<const ContentKey> keys,
             std::uint32_t generation);

    /// The host's objects are wanted; it says when they may be read, which is_let_in() tells.
    void ask_for_objects(std::uint64_t host_epoch);
    [[nodiscard]] bool is_let_in(std::uint64_t host_epoch) const;
    /// Makes room for the next one. `hears_motion` false: asks the host for another writer of
    /// motion, whose readers a forged packet can make deaf.
    void tell_objects_are_here(std::uint64_t host_epoch, bool hears_motion);
    /// They aren't wanted any more; who wants them again waits again.
    void leave_objects(std::uint64_t host_epoch);

    /// Refreshes the catalogue, hands over what has come, sends wishes and what is due.
    void step();
    /// What is served now, as of the last step().
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    /// How often that was called.
    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Objects : std::uint8_t // As in tactus_v5_Wanted.
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
        std::vector<HostPiece> wishes;
        std::uint32_t generation{0};
        std::uint64_t granted_sent{0}; ///< As last told to the host.
        std::uint32_t write_offs{0};   ///< Since the last sample came.
        bool awaits_pieces{false};     ///< Something was asked for since the last sample came.
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
    std::unique_ptr<WriterLanes> wanted_; ///< From create() on.
    std::shared_ptr<void> old_wanted_; ///< Writers before the last renewal: hosts may go by them.
    Endpoint chunks_;
    std::vector<PieceReceiver*> receivers_;
    std::vector<Host> hosts_;
    std::uint64_t seen_catalogue_{0};
    std::uint64_t steps_{0};
};

} // namespace tactus::dds
