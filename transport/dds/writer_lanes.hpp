// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/dds/topics.hpp"

#include <cstddef>
#include <cstdint>
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
    /// same type that may be lost. False when the sample is lost.
    bool write(const void* sample, const void* probe);

    [[nodiscard]] std::size_t open() const;

    static constexpr std::size_t kLanes = 4;
    /// Samples before a next lane is made.
    static constexpr std::uint64_t kSamplesALane = 64;

private:
    struct Lane
    {
        Endpoint writer;
        bool is_probed{false};
        bool is_open{false};
    };

    WriterLanes(const Domain& domain, Topic topic, std::string partition);

    void open_next(const void* probe);

    const Domain* domain_;
    Topic topic_;
    std::string partition_;
    std::vector<Lane> lanes_;
    std::size_t turn_{0};
    std::uint64_t written_{0};
};

} // namespace tactus::dds
