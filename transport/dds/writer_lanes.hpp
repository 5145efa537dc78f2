// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/handshake_watch.hpp"
#include "transport/dds/topics.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Up to kLanes writers of one topic in one partition, used in turn. Reliable delivery keeps the
/// order within each writer, so a lost datagram delays only that writer's later samples. Samples
/// may arrive out of order.
///
/// The first writer is open at once. A further one opens after kSamplesALane samples for each
/// present writer, once its reader has acknowledged a probe: samples written before the two sides
/// know each other are lost.
class WriterLanes
{
public:
    /// `domain` must outlive the lanes.
    [[nodiscard]] static Result<WriterLanes, Refusal> create(const Domain& domain, Topic topic,
                                                             const std::string& partition);

    /// True if the first writer has a reader.
    [[nodiscard]] bool is_matched() const { return dds::is_matched(lanes_[0].writer); }
    /// Writes with the next open writer. `probe` is a sample that may be lost, to open further
    /// writers; `bytes` is the memory that `sample` takes until it is acknowledged. False if the
    /// sample is lost: the write failed, or every open writer has more than kUnackedMax
    /// unacknowledged bytes.
    bool write(const void* sample, const void* probe, std::size_t bytes = 0);

    [[nodiscard]] std::size_t open() const;

    /// Replaces all writers by a new one. A packet in a writer's name with a much later sample
    /// number, perhaps forged, makes readers drop the writer's further samples. Returns the owner
    /// of the old writers, which take a while to delete. Null within the Backoff, since Cyclone
    /// keeps some memory of each former writer, or if no writer can be created.
    [[nodiscard]] std::shared_ptr<void> try_renew(Backoff::Clock::time_point now);

    static constexpr std::size_t kLanes = 4;
    /// Maximum unacknowledged bytes of a writer that may still write, in case its reader never
    /// answers.
    static constexpr std::size_t kUnackedMax = std::size_t{1} << 20U;
    /// Number of samples for each present lane after which a further lane is created.
    static constexpr std::uint64_t kSamplesALane = 64;

private:
    struct Lane
    {
        Endpoint writer;
        bool is_probed{false};
        bool is_open{false};
        /// Bytes written since all samples were last known to be acknowledged.
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
