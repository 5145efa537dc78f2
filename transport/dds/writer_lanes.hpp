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

/// Several writers of one topic in one partition that take turns. Reliable delivery keeps the order
/// of each writer, so a lost datagram delays only the later samples of its own writer. Samples may
/// arrive in another order than they were written.
///
/// There is one writer at first; the next one joins after some traffic, when its reader has
/// answered a probe: samples written before both sides know each other are lost.
class WriterLanes
{
public:
    /// `domain` must outlive the lanes.
    [[nodiscard]] static Result<WriterLanes, Refusal> create(const Domain& domain, Topic topic,
                                                             const std::string& partition);

    /// True if the first writer has a reader.
    [[nodiscard]] bool is_matched() const { return dds::is_matched(lanes_[0].writer); }
    /// Writes with the next open writer; without a reader the sample is lost. `probe` is a sample
    /// of the same type that may be lost, `bytes` the sample's size in a writer's memory until its
    /// reader has answered. False if the sample is lost: no writer holds more than kUnackedMax.
    bool write(const void* sample, const void* probe, std::size_t bytes = 0);

    [[nodiscard]] std::size_t open() const;

    /// Replaces all writers by a new one. A packet in a writer's name with a much later sample
    /// number, forged or not, makes its reader drop all further samples of that writer. Returns the
    /// owner of the old writers, whose deletion takes a while; null if it is not due: Cyclone keeps
    /// a little memory of each former writer.
    [[nodiscard]] std::shared_ptr<void> try_renew(Backoff::Clock::time_point now);

    static constexpr std::size_t kLanes = 4;
    /// Memory that a reader that never answers costs its writer: a second of a stream.
    static constexpr std::size_t kUnackedMax = std::size_t{1} << 20U;
    /// Samples before the next lane is created.
    static constexpr std::uint64_t kSamplesALane = 64;

private:
    struct Lane
    {
        Endpoint writer;
        bool is_probed{false};
        bool is_open{false};
        /// Bytes since all samples were acknowledged, as of the last check.
        std::size_t unacked_bytes{0};
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
