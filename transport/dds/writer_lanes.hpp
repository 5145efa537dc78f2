// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/backoff.hpp"
#include "transport/dds/topics.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Writers of one topic in one partition that take turns. Reliable delivery keeps the order of each
/// writer, so a datagram that is lost holds back what its own writer sent after it, not the rest.
/// What goes through lanes may come in another order.
///
/// There is one at first; a next one joins after some traffic, when its reader has answered a
/// probe: what is written before both sides know each other is lost.
class WriterLanes
{
public:
    /// `domain` must outlive the lanes.
    [[nodiscard]] static Result<WriterLanes, Refusal> create(const Domain& domain, Topic topic,
                                                             const std::string& partition);

    /// Whether the first of them has a reader.
    [[nodiscard]] bool is_matched() const { return dds::is_matched(lanes_[0].writer); }
    /// Writes by the next one that is open; without a reader to nobody. `probe` is a sample of the
    /// same type that may be lost, `bytes` what the sample takes in a writer's memory until its
    /// reader has answered. False when the sample is lost: no writer takes more than kUnackedMax.
    bool write(const void* sample, const void* probe, std::size_t bytes = 0);

    [[nodiscard]] std::size_t open() const;

    /// Makes a new writer in the place of them all: where a packet in a writer's name told its
    /// reader of a much later sample, forged or not, that reader takes all others for old as long
    /// as the writer is there. Returns what owns the old ones, whose deletion takes a while; null
    /// when it is not due: Cyclone keeps a little of each writer that was.
    [[nodiscard]] std::shared_ptr<void> try_renew(Backoff::Clock::time_point now);

    static constexpr std::size_t kLanes = 4;
    /// So much a reader that never answers costs its writer, a second of a stream.
    static constexpr std::size_t kUnackedMax = std::size_t{1} << 20U;
    /// Samples before a next lane is made.
    static constexpr std::uint64_t kSamplesALane = 64;

private:
    struct Lane
    {
        Endpoint writer;
        bool is_probed{false};
        bool is_open{false};
        std::size_t unacked_bytes{0}; ///< Since all was answered, as was last looked.
    };

    WriterLanes(const Domain& domain, Topic topic, std::string partition);

    void open_next(const void* probe);
    [[nodiscard]] static bool has_room(Lane& lane);

    const Domain* domain_;
    Topic topic_;
    std::string partition_;
    std::vector<Lane> lanes_;
    std::size_t turn_{0};
    std::uint64_t written_{0};
    Backoff renewals_;
};

} // namespace tactus::dds
