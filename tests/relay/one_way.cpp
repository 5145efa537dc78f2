// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/relay/one_way.hpp"

#include "tests/shared/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <tuple>
#include <utility>

namespace tactus::relay
{
namespace
{

constexpr std::size_t kEthernetBytes = 14;
constexpr std::size_t kIpBytesMin = 20;
constexpr std::size_t kUdpBytes = 8;
constexpr std::uint32_t kArp = 0x0806;
constexpr std::uint32_t kIpv4 = 0x0800;
constexpr std::uint32_t kUdp = 17;
constexpr std::uint32_t kFragmentOffset = 0x1FFF;

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t at)
{
    return std::to_integer<std::uint32_t>(bytes[at]);
}

/// Big-endian number of the wire.
std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at)
{
    return byte_at(bytes, at) << 8U | byte_at(bytes, at + 1);
}

FrameContent content_of_ip(std::span<const std::byte> packet)
{
    if (packet.size() < kIpBytesMin || byte_at(packet, 0) >> 4U != 4 || byte_at(packet, 9) != kUdp)
    {
        return {};
    }
    const std::size_t header = (byte_at(packet, 0) & 0xFU) * std::size_t{4};
    const std::size_t total = word_at(packet, 2); // A short frame is padded behind it.
    if (header < kIpBytesMin || total < header || total > packet.size())
    {
        return {};
    }
    const auto content = static_cast<std::uint32_t>(total - header);
    if ((word_at(packet, 6) & kFragmentOffset) != 0)
    {
        return {.udp_payload_bytes = content};
    }
    if (content < kUdpBytes)
    {
        return {};
    }
    return {.udp_datagrams = 1,
            .udp_payload_bytes = content - static_cast<std::uint32_t>(kUdpBytes)};
}

} // namespace

FrameContent content_of(std::span<const std::byte> frame)
{
    if (frame.size() < kEthernetBytes)
    {
        return {};
    }
    const std::uint32_t type = word_at(frame, kEthernetBytes - 2);
    if (type == kArp)
    {
        return {.is_arp = true};
    }
    return type == kIpv4 ? content_of_ip(frame.subspan(kEthernetBytes)) : FrameContent{};
}

namespace
{

struct Figure
{
    std::string_view name;
    double LinkCondition::*member;
    double most;
};

constexpr std::array<Figure, 4> kFigures{{{"delay-ms", &LinkCondition::delay_ms, kDelayMax_ms},
                                          {"jitter-ms", &LinkCondition::jitter_ms, kDelayMax_ms},
                                          {"loss", &LinkCondition::loss, 1.0},
                                          {"duplicates", &LinkCondition::duplicates, 1.0}}};

/// Number in 0 .. `most` that is all of `text`.
std::optional<double> parse_number(std::string_view text, double most)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && value >= 0.0 && value <= most ? std::optional(value) : std::nullopt;
}

/// Parses "FIGURE VALUE".
std::optional<Command> parse_set(std::string_view words)
{
    const std::size_t space = words.find(' ');
    const auto* const figure = std::ranges::find(kFigures, words.substr(0, space), &Figure::name);
    if (figure == kFigures.end() || space == std::string_view::npos)
    {
        return std::nullopt;
    }
    const std::optional<double> value = parse_number(words.substr(space + 1), figure->most);
    return value ? std::optional<Command>(Set{figure->member, *value}) : std::nullopt;
}

} // namespace

std::optional<Command> parse_command(std::string_view line)
{
    constexpr std::string_view kSet = "set ";
    if (line == "cut")
    {
        return Cut{};
    }
    if (line == "cut to-controller")
    {
        return Cut{true, false};
    }
    if (line == "cut to-server")
    {
        return Cut{false, true};
    }
    if (line == "restore")
    {
        return Restore{};
    }
    if (line == "count")
    {
        return Count{};
    }
    return line.starts_with(kSet) ? parse_set(line.substr(kSet.size())) : std::nullopt;
}

std::string command_forms()
{
    std::string forms = "cut, cut to-controller, cut to-server, restore, count";
    for (const Figure& figure : kFigures)
    {
        forms += fmt::format(", set {} 0..{}", figure.name, figure.most);
    }
    return forms;
}

namespace
{

/// Random numbers of one frame.
constexpr std::uint64_t kLoss = 0;
constexpr std::uint64_t kDuplicate = 1;
/// Jitter of the first copy; the next number is the second copy's.
constexpr std::uint64_t kJitter = 2;
constexpr std::uint64_t kNumbers = 4;

/// Uniform number in 0 .. 1, without 1: a share of 1 takes every frame and one of 0 none.
double unit(std::uint64_t seed, std::uint64_t index)
{
    return static_cast<double>(test::mixed(seed, index) >> 11U) * 0x1p-53;
}

} // namespace

FrameFate FrameFates::next(const LinkCondition& condition, bool must_arrive)
{
    const std::uint64_t first = kNumbers * frame_++;
    FrameFate fate;
    if (!must_arrive && unit(seed_, first + kLoss) < condition.loss)
    {
        return fate;
    }
    const bool is_twice = !must_arrive && unit(seed_, first + kDuplicate) < condition.duplicates;
    fate.copies = is_twice ? 2 : 1;
    for (std::size_t i = 0; i < fate.copies; ++i)
    {
        const double delay_ms =
            condition.delay_ms + condition.jitter_ms * unit(seed_, first + kJitter + i);
        fate.delays[i] = nanoseconds(static_cast<std::int64_t>(delay_ms * 1e6));
    }
    return fate;
}

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
