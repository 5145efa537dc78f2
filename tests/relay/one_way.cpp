// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/one_way.hpp"

#include "tests/relay/frame_content.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tactus::relay
{

void OneWay::take(std::span<const std::byte> frame, const LinkCondition& condition,
                  MonotonicTime now)
{
    const FrameContent content = content_of(frame);
    ++counts_.frames;
    counts_.bytes += frame.size();
    counts_.udp_datagrams += content.udp_datagrams;
    counts_.udp_payload_bytes += content.udp_payload_bytes;
    // A lost ARP costs the system's retry of a second, which is not to be measured.
    const FrameFate fate = fates_.next(condition, content.is_arp);
    if (is_cut_)
    {
        ++counts_.cut;
        return;
    }
    counts_.lost += fate.copies == 0 ? 1U : 0U;
    counts_.duplicated += fate.copies == 2 ? 1U : 0U;
    for (std::size_t i = 0; i < fate.copies; ++i)
    {
        enqueue(frame, now + fate.delays[i]);
    }
}

void OneWay::enqueue(std::span<const std::byte> frame, MonotonicTime due)
{
    const std::size_t bytes = frame.size() + sizeof(Waiting);
    if (bytes_waiting_ + bytes > bytes_max_)
    {
        ++counts_.dropped_full;
        return;
    }
    bytes_waiting_ += bytes;
    heap_.push_back({due, next_order_++, {frame.begin(), frame.end()}});
    std::ranges::push_heap(heap_, is_later);
}

std::optional<MonotonicTime> OneWay::next_due() const
{
    return heap_.empty() ? std::nullopt : std::optional(heap_.front().due);
}

std::optional<std::vector<std::byte>> OneWay::take_due(MonotonicTime now)
{
    if (heap_.empty() || heap_.front().due > now)
    {
        return std::nullopt;
    }
    std::ranges::pop_heap(heap_, is_later);
    std::vector<std::byte> frame = std::move(heap_.back().frame);
    heap_.pop_back();
    bytes_waiting_ -= frame.size() + sizeof(Waiting);
    ++counts_.delivered;
    return frame;
}

void OneWay::cut()
{
    is_cut_ = true;
    counts_.cut += heap_.size();
    heap_.clear();
    bytes_waiting_ = 0;
}

bool OneWay::is_later(const Waiting& a, const Waiting& b)
{
    return std::tie(a.due, a.order) > std::tie(b.due, b.order);
}

} // namespace tactus::relay
