// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"

#include "platform/choices/messages.hpp"
#include "platform/devices/device_force.hpp"
#include "platform/devices/dhd/dhd_device.hpp"
#include "platform/devices/dhd/dhd_guard.hpp"
#include "platform/devices/plugin/device_plugin.hpp"
#include "platform/devices/simulated/replay_device.hpp"
#include "platform/devices/udp/udp_device.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

namespace tactus::hrtc
{

namespace
{

constexpr int kPortMin = 1'024;
constexpr int kPortMax = 65'535;
constexpr int kFaultFramesMax = 1'000'000'000;

struct NamedFault
{
    std::string_view name;
    DeviceFaultKind kind;
};
constexpr NamedFault kFaults[] = {
    {"jitter", DeviceFaultKind::jitter},       {"dropout", DeviceFaultKind::dropout},
    {"stuck", DeviceFaultKind::stuck},         {"nan", DeviceFaultKind::nan},
    {"time_jump", DeviceFaultKind::time_jump}, {"disconnect", DeviceFaultKind::disconnect},
};

/// Parses the whole of `text` as an integer in the range.
std::optional<int> parse_int(std::string_view text, int least, int most)
{
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_good =
        error == std::errc{} && end == text.data() + text.size() && value >= least && value <= most;
    return is_good ? std::optional(value) : std::nullopt;
}

std::optional<DeviceChoice> parse_class(std::string_view text)
{
    DeviceChoice choice;
    if (text == "touch")
    {
        choice.limits = kTouchClass;
        return choice;
    }
    if (text == "omega" || text == "delta")
    {
        choice.limits = text == "omega" ? kOmegaClass : kDeltaClass;
        return choice;
    }
    return std::nullopt;
}

std::optional<DeviceChoice> parse_udp(std::string_view text)
{
    DeviceChoice choice;
    choice.kind = DeviceKind::udp;
    const std::size_t colon = text.rfind(':');
    if (colon != std::string_view::npos)
    {
        choice.address = text.substr(0, colon);
        text = text.substr(colon + 1);
    }
    const std::optional<int> port = parse_int(text, kPortMin, kPortMax);
    choice.port = port.value_or(0);
    return port && !choice.address.empty() ? std::optional(choice) : std::nullopt;
}

std::optional<DeviceChoice> parse_dhd(std::string_view text)
{
    DeviceChoice choice;
    choice.kind = DeviceKind::dhd;
    choice.limits = DhdDeviceOptions::default_info().limits;
    const std::optional<int> index = parse_int(text, 0, DhdDeviceOptions::kIndexMax);
    choice.index = index.value_or(0);
    return index ? std::optional(choice) : std::nullopt;
}

template <class Device>
Result<std::unique_ptr<HapticDevice>, Refusal>
as_device(Result<std::unique_ptr<Device>, Refusal> made)
{
    if (!made)
    {
        return made.error();
    }
    return std::unique_ptr<HapticDevice>(std::move(made).value());
}

Result<std::unique_ptr<HapticDevice>, Refusal> open_replay(const std::string& path,
                                                           std::size_t tool)
{
    auto motion = read_recorded_motion(path, tool);
    if (!motion)
    {
        return motion.error();
    }
    auto device = ReplayDevice::create(std::move(motion).value());
    if (!device)
    {
        return Refusal{path + ": " + device.error().text};
    }
    return as_device(std::move(device));
}

/// Device that the text gives; none if it gives no device.
std::optional<DeviceChoice> device_named(std::string_view text)
{
    constexpr std::string_view kSimulated = "sim:";
    constexpr std::string_view kUdp = "udp:";
    constexpr std::string_view kDhd = "dhd:";
    constexpr std::string_view kReplay = "replay:";
    constexpr std::string_view kPlugin = "plugin:";
    DeviceChoice choice;
    if (text == "sim")
    {
        return choice;
    }
    if (text == "udp")
    {
        choice.kind = DeviceKind::udp;
        return choice;
    }
    if (text == "dhd")
    {
        return parse_dhd("0");
    }
    if (text.starts_with(kSimulated))
    {
        return parse_class(text.substr(kSimulated.size()));
    }
    if (text.starts_with(kUdp))
    {
        return parse_udp(text.substr(kUdp.size()));
    }
    if (text.starts_with(kReplay) && text.size() > kReplay.size())
    {
        choice.kind = DeviceKind::replay;
        choice.recording = text.substr(kReplay.size());
        return choice;
    }
    if (text.starts_with(kPlugin) && text.substr(kPlugin.size()).starts_with('/'))
    {
        const std::size_t comma = std::min(text.find(','), text.size());
        choice.kind = DeviceKind::plugin;
        choice.library = text.substr(kPlugin.size(), comma - kPlugin.size());
        choice.words = text.substr(std::min(comma + 1, text.size()));
        return choice;
    }
    return text.starts_with(kDhd) ? parse_dhd(text.substr(kDhd.size())) : std::nullopt;
}

/// Refusal of a text that names no device. It lists the forms of the text's kind, or else all
/// kinds.
Refusal no_device(std::string_view text)
{
    constexpr std::pair<std::string_view, std::string_view> kForms[] = {
        {"sim", "sim, or sim:CLASS with touch, omega or delta"},
        {"udp", "udp, udp:PORT, or udp:ADDRESS:PORT with a numeric IPv4 address and a port of 1024 "
                "to 65535"},
        {"dhd", "dhd, or dhd:INDEX with 0 to 63"},
        {"plugin",
         "plugin:FILE[,WORDS] with the full path of a library that has a TACTUS_DEVICE_PLUGIN"},
        {"replay", "replay:FILE with a recording of hrtc --record"}};
    for (const auto& [kind, forms] : kForms)
    {
        if (text.starts_with(kind))
        {
            return {fmt::format("'{}' is not {}", printable(text), forms)};
        }
    }
    constexpr std::string_view kWords[] = {"sim",       "udp",       "dhd",    "sim:touch",
                                           "sim:omega", "sim:delta", "plugin", "replay"};
    const std::string_view word = text.substr(0, text.find(':'));
    const std::string of_class = fmt::format("sim:{}", word);
    const std::string nearest = device_named(of_class) ? of_class : nearest_word(word, kWords);
    return {nearest.empty() ? fmt::format("'{}' is not sim, udp, dhd, plugin:FILE or replay:FILE",
                                          printable(text))
                            : fmt::format("'{}': no device is called '{}'; {}?", printable(text),
                                          printable(word), nearest)};
}

} // namespace

Result<DeviceChoice, Refusal> parse_device(std::string_view text)
{
    auto device = device_named(text);
    return device ? Result<DeviceChoice, Refusal>(*std::move(device)) : no_device(text);
}

std::optional<DeviceFault> parse_device_fault(std::string_view text)
{
    const std::size_t at = std::min(text.find('@'), text.size());
    const std::size_t plus = std::min(text.find('+', at), text.size());
    const auto* const named = std::ranges::find(kFaults, text.substr(0, at), &NamedFault::name);
    if (named == std::end(kFaults) || plus == text.size())
    {
        return std::nullopt;
    }
    const std::optional<int> frame =
        parse_int(text.substr(at + 1, plus - at - 1), 0, kFaultFramesMax);
    const std::optional<int> length = parse_int(text.substr(plus + 1), 1, kFaultFramesMax);
    if (!frame || !length)
    {
        return std::nullopt;
    }
    return DeviceFault{named->kind, static_cast<std::uint64_t>(*frame),
                       static_cast<std::uint64_t>(*length)};
}

Result<std::unique_ptr<HapticDevice>, Refusal> open_device(const DeviceChoice& choice,
                                                           std::size_t tool, const DeviceWait& wait,
                                                           const Clock& clock)
{
    if (choice.kind == DeviceKind::replay)
    {
        return open_replay(choice.recording, tool);
    }
    if (choice.kind == DeviceKind::program)
    {
        return choice.make();
    }
    auto frame = DeviceFrame::create(choice.frame);
    if (!frame)
    {
        return frame.error();
    }
    if (choice.kind == DeviceKind::plugin)
    {
        return load_device(choice.library, {wait.rate_hz, frame.value(), choice.words.c_str()});
    }
    if (choice.kind == DeviceKind::udp)
    {
        UdpDeviceOptions options;
        options.address = choice.address;
        options.port = choice.port;
        options.authenticator = choice.authenticator.get();
        options.wait = wait.most;
        options.goes_on = [asked = 0, told = wait.goes_on, choice]() mutable
        {
            constexpr int kQuiet =
                static_cast<int>(milliseconds(1'000) / UdpDeviceOptions::kAskEvery);
            if (++asked == kQuiet)
            {
                log_line(fmt::format("waiting for a driver to describe its device to {}:{}",
                                     choice.address, choice.port));
            }
            return !told || told();
        };
        options.frame = frame.value();
        options.clock = &clock;
        return as_device(UdpDevice::create(options));
    }
    DhdDeviceOptions options;
    options.index = choice.index;
    options.info.limits = choice.limits;
    options.frame = frame.value();
    options.clock = &clock;
    return as_device(DhdDevice::create(options));
}

bool wants_guard(const DeviceChoice& choice) noexcept
{
    return choice.kind == DeviceKind::dhd || choice.kind == DeviceKind::plugin;
}

Result<std::unique_ptr<DeviceGuard>, Refusal> open_guard(const DeviceChoice& choice,
                                                         std::int64_t rate_hz)
{
    if (choice.kind == DeviceKind::dhd)
    {
        return DhdGuard::create(DhdDeviceOptions{}.library, choice.index);
    }
    auto frame = DeviceFrame::create(choice.frame);
    if (!frame)
    {
        return frame.error();
    }
    return load_guard(choice.library, {rate_hz, frame.value(), choice.words.c_str()});
}

namespace
{

std::optional<std::array<double, 3>> to_array(const std::optional<Vec3>& v)
{
    return v ? std::optional(tactus::to_array(*v)) : std::nullopt;
}

/// Sample as the device reported it; without a rotation if the device measured none.
DeviceSample reading_of(const ToolState& state, const DeviceRecord& device)
{
    const DevicePose pose = device.pose.value_or(DevicePose{state.position_m, state.rotation});
    DeviceSample reading;
    reading.position_world_m = tactus::to_array(pose.position_m);
    reading.velocity_world_m_per_s = to_array(device.velocity_m_per_s);
    reading.time = MonotonicTime{state.sample_time_ns};
    reading.connected = device.connected;
    reading.valid = state.valid;
    reading.deadman_held = device.deadman_held;
    if (device.measures_rotation)
    {
        const bool is_sound = is_rotation(pose.rotation, kRotationTolerance);
        reading.rotation_world =
            is_sound ? to_quaternion(orthonormalised(pose.rotation)) : Quaternion{};
    }
    reading.angular_velocity_world_rad_per_s = to_array(device.angular_velocity_rad_per_s);
    reading.buttons = device.buttons;
    reading.gripper_m = device.gripper_m;
    return reading;
}

} // namespace

Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path, std::size_t tool)
{
    const auto recording = Recording::read(path);
    if (!recording)
    {
        return recording.error();
    }
    if (const std::string missing = recording.value().missing(); !missing.empty())
    {
        log_line(path + ": " + missing);
    }
    const RecordedSetup& setup = recording.value().setup();
    const std::size_t played = tool < setup.tools.size() ? tool : 0;
    ReplayDeviceOptions options;
    options.rate_hz = std::llround(1e9 / static_cast<double>(setup.period_ns));
    options.limits.force_max_n = setup.tools[played].force_max_n;
    options.limits.rotation = kDeskRotation;
    options.limits.rotation.torque_max_nm = setup.tools[played].torque_max_nm;
    options.readings.reserve(recording.value().frame_count());
    FrameDecoder decoder(recording.value().shape());
    for (ByteReader reader(recording.value().frames()); !reader.at_end();)
    {
        const char* fault = decoder.decode(reader);
        TACTUS_ASSERT(fault == nullptr); // The recording was checked as a whole.
        options.readings.push_back(
            reading_of(decoder.frame().tools[played], decoder.frame().devices[played]));
    }
    return options;
}

} // namespace tactus::hrtc
