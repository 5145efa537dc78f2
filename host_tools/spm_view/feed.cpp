// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/feed.hpp"

#include "transport/content_hash.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string_view>

namespace tactus::view
{

namespace
{

/// Bytes of a text in a datagram, with at least one zero at its end.
constexpr std::size_t kFeedTextBytes = 64;
static_assert(kFeedTextBytes > kMaxNameBytes && kFeedTextBytes > kMaxShapeBytes);
/// Bytes of the head, of one tool and of one object in a datagram.
constexpr std::array<std::uint16_t, 3> kFeedSizes{128, 256, 160};
static_assert(std::endian::native == std::endian::little);

/// Objects of one datagram or event, and its number among those of the same state.
struct FeedPart
{
    std::span<const ObjectTelemetry> objects;
    std::uint16_t number{0};
    std::uint16_t count{1};
};

/// Writes fields as JSON.
class JsonFields
{
public:
    template <typename Value>
    void value(const char* name, const Value& value)
    {
        json_[name] = value;
    }
    void text(const char* name, std::string_view text) { json_[name] = text; }
    void identity(const char* name, const std::array<std::uint8_t, 16>& bytes)
    {
        json_[name] = hash_text(bytes);
    }
    /// A number that JSON's readers would round.
    void identity(const char* name, std::uint64_t number)
    {
        json_[name] = fmt::format("{:016x}", number);
    }
    void flags(std::initializer_list<std::pair<const char*, bool>> flags)
    {
        for (const auto& [name, is_set] : flags)
        {
            json_[name] = is_set;
        }
    }
    template <typename Records, typename Tell>
    void records(const char* name, const Records& records, const Tell& tell)
    {
        auto list = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < std::size(records); ++i)
        {
            JsonFields fields;
            tell(fields, i);
            list.push_back(std::move(fields.json_));
        }
        json_[name] = std::move(list);
    }
    [[nodiscard]] const nlohmann::ordered_json& json() const noexcept { return json_; }

private:
    nlohmann::ordered_json json_;
};

/// Writes fields as the bytes of packed records.
class PackedFields
{
public:
    template <typename Number>
    requires std::integral<Number> || std::floating_point<Number>
    void value(const char* /*name*/, Number number) { put(&number, sizeof(number)); }
    template <typename Number, std::size_t size>
    void value(const char* /*name*/, const std::array<Number, size>& numbers)
    {
        put(numbers.data(), sizeof(numbers));
    }
    void text(const char* /*name*/, std::string_view text)
    {
        const std::size_t size = std::min(text.size(), kFeedTextBytes - 1);
        bytes_.append(text.substr(0, size)).append(kFeedTextBytes - size, '\0');
    }
    void identity(const char* name, const auto& identity) { value(name, identity); }
    void flags(std::initializer_list<std::pair<const char*, bool>> flags)
    {
        std::uint32_t bits = 0;
        for (std::uint32_t bit = 1; const auto& [name, is_set] : flags)
        {
            bits |= is_set ? bit : 0U;
            bit <<= 1U;
        }
        put(&bits, sizeof(bits));
    }
    template <typename Records, typename Tell>
    void records(const char* /*name*/, const Records& records, const Tell& tell)
    {
        for (std::size_t i = 0; i < std::size(records); ++i)
        {
            tell(*this, i);
        }
    }
    [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

private:
    void put(const void* from, std::size_t size)
    {
        bytes_.append(static_cast<const char*>(from), size);
    }

    std::string bytes_;
};

/// Fields of one tool. Its state and shape come with the refinement state; before one was received
/// they are `reset` and empty.
template <typename Fields>
void tell_feed_tool(Fields& fields, const LiveController& controller, std::size_t number)
{
    const ToolTelemetry& tool = controller.told.telemetry.tools[number];
    const RefinementState* state = controller.state();
    const RefinementStateTool shape = state != nullptr && number < state->tools.size()
                                          ? state->tools[number]
                                          : RefinementStateTool{};
    fields.value("number", static_cast<std::uint32_t>(number));
    fields.flags({{"in_contact", tool.in_contact},
                  {"halted", tool.halted},
                  {"over_constrained", tool.over_constrained},
                  {"data_limited", tool.data_limited},
                  {"has_gripper", tool.has_gripper}});
    fields.value("buttons", tool.buttons);
    fields.value("state", static_cast<std::uint32_t>(shape.state));
    fields.value("position_m", tool.position_m);
    fields.value("rotation", tool.rotation);
    fields.value("proxy_m", tool.proxy_m);
    fields.value("proxy_rotation", tool.proxy_rotation);
    fields.value("force_n", tool.force_n);
    fields.value("torque_nm", tool.torque_nm);
    fields.value("gripper_m", tool.gripper_m);
    fields.value("radius_m", shape.radius_m);
    fields.text("shape", shape.shape);
}

template <typename Fields>
void tell_feed_object(Fields& fields, const ObjectTelemetry& object)
{
    fields.value("number", object.number);
    fields.value("object", object.object);
    fields.identity("server", object.server_epoch);
    fields.value("translation_m", object.pose.translation_m);
    fields.value("rotation", object.pose.rotation);
    fields.value("scale", object.pose.scale);
    fields.identity("model", object.model);
    fields.text("name", object.name);
}

/// All fields, in the order of both forms.
template <typename Fields>
void tell_feed(Fields& fields, const LiveController& controller, const FeedPart& part)
{
    const Telemetry& telemetry = controller.told.telemetry;
    const auto tools = std::span(telemetry.tools).first(telemetry.tool_count);
    fields.value("version", kFeedVersion);
    fields.value("tool_count", static_cast<std::uint16_t>(tools.size()));
    fields.value("object_count", static_cast<std::uint16_t>(part.objects.size()));
    fields.value("part", part.number);
    fields.value("part_count", part.count);
    fields.value("period_ns", static_cast<std::uint32_t>(telemetry.period_ns));
    fields.value("serial", controller.told.serial);
    fields.value("frame", telemetry.frame);
    fields.value("time_ns", telemetry.time_ns);
    fields.identity("controller", controller.told.id);
    fields.text("name", controller.told.name);
    fields.records("tools", tools,
                   [&](Fields& each, std::size_t i) { tell_feed_tool(each, controller, i); });
    fields.records("objects", part.objects,
                   [&](Fields& each, std::size_t i) { tell_feed_object(each, part.objects[i]); });
}

} // namespace

std::string feed_json(const LiveController& controller)
{
    JsonFields fields;
    tell_feed(fields, controller, {controller.objects});
    return fields.json().dump();
}

nlohmann::ordered_json feed_tool(const LiveController& controller, std::size_t number)
{
    JsonFields fields;
    tell_feed_tool(fields, controller, number);
    return fields.json();
}

nlohmann::ordered_json feed_object(const ObjectTelemetry& object)
{
    JsonFields fields;
    tell_feed_object(fields, object);
    return fields.json();
}

std::vector<std::string> feed_datagrams(const LiveController& controller)
{
    const std::span<const ObjectTelemetry> objects = controller.objects;
    const std::size_t count =
        std::max<std::size_t>((objects.size() + kFeedObjects - 1) / kFeedObjects, 1);
    std::vector<std::string> datagrams;
    for (std::size_t part = 0; part < count; ++part)
    {
        const auto rest = objects.subspan(part * kFeedObjects);
        PackedFields fields;
        fields.value("magic", std::array{'T', 'F', 'E', 'D'});
        fields.value("sizes", kFeedSizes);
        tell_feed(fields, controller,
                  {rest.first(std::min(rest.size(), kFeedObjects)),
                   static_cast<std::uint16_t>(part), static_cast<std::uint16_t>(count)});
        datagrams.push_back(fields.bytes());
    }
    return datagrams;
}

Result<FeedSender, Refusal> FeedSender::open(const udp::Endpoint& to)
{
    const bool is_loopback = to.address >> 24U == 127U;
    auto socket = udp::Socket::open(is_loopback ? "127.0.0.1" : "0.0.0.0", 0);
    if (!socket)
    {
        return Refusal{"--feed-udp: " + socket.error().text};
    }
    return FeedSender(std::move(socket).value(), to);
}

void FeedSender::send(const Snapshot& snapshot)
{
    std::map<dds::ControllerId, std::uint64_t> sent;
    for (const LiveController& controller : snapshot.controllers)
    {
        const dds::WatchedController& told = controller.told;
        sent[told.id] = told.serial;
        if (const auto last = sent_.find(told.id);
            last != sent_.end() && last->second == told.serial)
        {
            continue;
        }
        for (const std::string& datagram : feed_datagrams(controller))
        {
            static_cast<void>(socket_.send(std::as_bytes(std::span(datagram)), to_));
        }
    }
    sent_ = std::move(sent); // Without controllers that are gone.
}

} // namespace tactus::view
