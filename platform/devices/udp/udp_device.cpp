// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/udp_device.hpp"

#include "platform/devices/device_force.hpp"
#include "platform/machine/posix/linux_extras.hpp"
#include "transport/base/number_form.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

using udp::DatagramFault;

/// Buffer of one byte more than any datagram, so that a longer one is detected.
using Buffer = std::array<std::byte, udp::kDatagramBytesMax + 1>;

/// Fault of the options; empty if none.
std::string find_bad_option(const UdpDeviceOptions& options)
{
    using Options = UdpDeviceOptions;
    if (options.poll < Options::kPollMin || options.poll > Options::kPollMax)
    {
        return "udp device: the poll interval must be in range 20 us..10 ms";
    }
    if (options.wait < Duration{} || options.wait > Options::kWaitMax)
    {
        return "udp device: the wait for a device must be in range 0..3600 s";
    }
    if (options.place < Duration{} || options.place > Options::kWaitMax)
    {
        return "udp device: the time that a device keeps its place must be in range 0..3600 s";
    }
    if (options.proof < Duration{} || options.proof > Options::kWaitMax)
    {
        return "udp device: the time that a device has to prove itself must be in range 0..3600 s";
    }
    if (options.transport_delay < Duration{} || options.transport_delay > Options::kDelayMax)
    {
        return "udp device: the transport delay must be in range 0..100 ms";
    }
    return find_bad_time(options.times);
}

/// Draws an unpredictable session number, never 0.
Result<std::uint64_t, Refusal> draw_secret()
{
    std::uint64_t secret = 0;
    if (!linux_extras::draw_random(std::as_writable_bytes(std::span(&secret, 1))))
    {
        return Refusal{"udp device: the system returned no random number"};
    }
    return secret == 0 ? 1 : secret;
}

std::span<const std::byte> part_of(const Buffer& buffer, std::size_t bytes) noexcept
{
    return std::span(buffer).first(bytes);
}

/// Text such as "wrong version", with the value at fault for wrong content.
std::string words_of(DatagramFault fault, std::span<const std::byte> bytes)
{
    const char* wrong = nullptr;
    static_cast<void>(udp::decode_from_device(bytes, &wrong));
    const std::string words(udp::text_of(fault));
    return fault == DatagramFault::content && wrong != nullptr ? words + ": " + wrong : words;
}

Refusal no_driver(const udp::Socket& socket, const udp::Session& session, Duration wait,
                  std::uint64_t refused, const std::string& last)
{
    const std::string within = " within " + std::to_string(wait / milliseconds(1)) + " ms";
    if (session.peer().is_attached && session.rival())
    {
        return {"udp device: more than one device describes itself to " +
                udp::text_of(socket.endpoint()) + ", from " +
                udp::text_of(session.peer().endpoint) + " and from " +
                udp::text_of(session.rival()->endpoint) + ", and none stopped" + within +
                "; use a key to distinguish them (docs/udp-device.md)"};
    }
    std::string line = "udp device: no device described itself to " +
                       udp::text_of(socket.endpoint()) +
                       (session.info() ? " and sent samples" : "") + within;
    line +=
        refused == 0
            ? session.info()
                  ? ""
                  : "; no datagram arrived; check that its driver runs and sends to this address"
            : " (" + counted(refused, "datagram") + " refused, the last: " + last + ")";
    return {std::move(line)};
}

bool send_to(const udp::Socket& socket, const udp::ForceDatagram& datagram, const udp::Endpoint& to,
             const udp::Authenticator* authenticator) noexcept
{
    const udp::Datagram plain = encode(datagram);
    return socket.send(authenticator != nullptr ? authenticated(plain, *authenticator) : plain, to);
}

/// Sends the attached device its session number, which its samples need.
void answer(const udp::Socket& socket, const udp::Session& session, std::uint64_t sequence,
            const udp::Authenticator* authenticator) noexcept
{
    const udp::Peer& peer = session.peer();
    udp::ForceDatagram datagram;
    datagram.address = {peer.instance, peer.session, sequence};
    datagram.version = peer.version;
    datagram.answers = session.answers();
    static_cast<void>(
        send_to(socket, datagram, peer.endpoint, authenticator)); // A lost answer is repeated.
}

/// Waits until the session has settled on a device, or returns the refusal. Counts `sequence` up to
/// the number of the last datagram sent.
std::optional<Refusal> await_device(const udp::Socket& socket, udp::Session& session,
                                    const UdpDeviceOptions& options, std::uint64_t& sequence)
{
    constexpr Duration kAnswerEvery = milliseconds(5);
    const MonotonicTime start = options.clock->now();
    const MonotonicTime end = start + options.wait;
    MonotonicTime asked = start;
    MonotonicTime answered = start;
    Buffer buffer{};
    std::uint64_t refused = 0;
    std::string last;
    for (;;)
    {
        const auto received = socket.receive(buffer);
        const MonotonicTime now = options.clock->now();
        bool is_due = now - answered >= kAnswerEvery;
        if (received)
        {
            const auto result =
                session.receive(part_of(buffer, received->bytes), received->from, now);
            const auto* refusal = std::get_if<DatagramFault>(&result);
            is_due |= refusal == nullptr;
            refused += refusal != nullptr ? 1U : 0U;
            last = refusal != nullptr ? words_of(*refusal, part_of(buffer, received->bytes)) : last;
        }
        static_cast<void>(session.lapse(now));
        const bool is_attached = session.peer().is_attached;
        if (is_attached && (options.proof == Duration{} || session.is_proven(options.proof, now)))
        {
            session.settle();
            return std::nullopt;
        }
        if (is_attached && is_due)
        {
            answered = now;
            answer(socket, session, ++sequence, options.authenticator);
        }
        const bool is_to_ask = now - asked >= UdpDeviceOptions::kAskEvery || now == start;
        asked = is_to_ask ? now : asked;
        if (now >= end || (is_to_ask && options.goes_on && !options.goes_on()))
        {
            return no_driver(socket, session, std::min(now - start, options.wait), refused, last);
        }
        socket.wait(std::min(end - now, is_attached ? kAnswerEvery : UdpDeviceOptions::kAskEvery));
    }
}

DeviceInfo with_delay(DeviceInfo info, Duration delay)
{
    info.limits.delay_s += to_seconds(delay);
    return info;
}

} // namespace

Result<std::unique_ptr<UdpDevice>, Refusal> UdpDevice::create(const UdpDeviceOptions& options)
{
    auto socket = udp::Socket::open(options.address, options.port);
    if (!socket)
    {
        return socket.error();
    }
    return create(std::move(socket).value(), options);
}

Result<std::unique_ptr<UdpDevice>, Refusal> UdpDevice::create(udp::Socket socket,
                                                              const UdpDeviceOptions& options)
{
    TACTUS_ASSERT(options.clock != nullptr);
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{std::move(wrong)};
    }
    const auto secret = draw_secret();
    if (!secret)
    {
        return secret.error();
    }
    udp::Session session(secret.value(), options.times.silence, options.place,
                         options.authenticator);
    std::uint64_t sequence = 0;
    if (auto refusal = await_device(socket, session, options, sequence))
    {
        return std::move(*refusal);
    }
    const DeviceInfo info = with_delay(*session.info(), options.transport_delay);
    std::unique_ptr<UdpDevice> device(
        new UdpDevice(std::move(socket), std::move(session), sequence, info, options));
    auto thread = RtThread::start(options.thread, [raw = device.get()] { raw->run(); });
    if (!thread)
    {
        return thread.error();
    }
    device->thread_ = std::move(thread).value();
    return device;
}

UdpDevice::UdpDevice(udp::Socket socket, udp::Session session, std::uint64_t sequence,
                     const DeviceInfo& info, const UdpDeviceOptions& options)
    : RemoteDevice(info, options.frame, options.times, *options.clock)
    , socket_(std::move(socket))
    , poll_(options.poll)
    , authenticator_(options.authenticator)
    , sequence_(sequence)
    , session_(std::move(session))
{
    counts_.described = 1;
    counts_.sessions = 1;
    peer_.write(session_.peer());
    traffic_.write(counts_);
}

UdpDevice::~UdpDevice()
{
    is_stopped_.store(true);
    thread_.reset();
}

UdpTraffic UdpDevice::traffic() const noexcept
{
    UdpTraffic traffic;
    while (!traffic_.try_read(traffic))
    {
    }
    return traffic;
}

void UdpDevice::run() noexcept
{
    // The first answer is to the description that create() received.
    bool is_asked = true;
    while (!is_stopped_.load())
    {
        if (session_.lapse(clock().now()))
        {
            ++counts_.lost;
            detach();
            peer_.write({});
        }
        send_due(is_asked);
        traffic_.write(counts_);
        socket_.wait(session_.peer().is_attached ? poll_ : kIdlePoll);
        is_asked = receive_all();
    }
    send(session_.peer(), sequence_.fetch_add(1) + 1, {}, session_.answers());
}

/// True if the device has sent a datagram that needs an answer.
bool UdpDevice::receive_all() noexcept
{
    Buffer buffer{};
    bool is_asked = false;
    for (int i = 0; i < kDatagramsMax; ++i)
    {
        const auto received = socket_.receive(buffer);
        if (!received)
        {
            break;
        }
        is_asked |= receive_one(part_of(buffer, received->bytes), received->from);
    }
    return is_asked;
}

bool UdpDevice::receive_one(std::span<const std::byte> bytes, const udp::Endpoint& from)
{
    const std::uint64_t session = session_.peer().session;
    const auto result = session_.receive(bytes, from, clock().now());
    if (const auto* refusal = std::get_if<DatagramFault>(&result))
    {
        ++counts_.refused.at(static_cast<std::size_t>(*refusal));
        counts_.others += *refusal == DatagramFault::other_device ? 1U : 0U;
        if (*refusal == DatagramFault::content)
        {
            static_cast<void>(udp::decode_from_device(bytes, &counts_.wrong_value));
        }
        return false;
    }
    counts_.others = 0;
    if (const auto* sampled = std::get_if<udp::Sampled>(&result))
    {
        ++counts_.samples;
        publish(sampled->reading, sampled->is_new);
    }
    else
    {
        ++counts_.described;
    }
    counts_.sessions += session_.peer().session != session ? 1U : 0U;
    peer_.write(session_.peer());
    return true;
}

/// Draws the sequence number before it reads the command. A brake after the draw gets a greater
/// number, so the device refuses this datagram as stale; an earlier brake is in the command.
void UdpDevice::send_due(bool is_asked) noexcept
{
    const udp::Peer& peer = session_.peer();
    const MonotonicTime now = clock().now();
    const DeviceCommand next = command();
    const bool is_other = next.written != sent_.written || next.state != sent_.state;
    if (!peer.is_attached || !(is_asked || is_other || now - sent_at_ >= kRepeat))
    {
        return;
    }
    const std::uint64_t sequence = sequence_.fetch_add(1) + 1;
    sent_ = command();
    sent_at_ = now;
    send(peer, sequence, sent_, session_.answers());
}

void UdpDevice::send(const udp::Peer& peer, std::uint64_t sequence, const DeviceCommand& command,
                     std::uint64_t answers) noexcept
{
    udp::ForceDatagram datagram;
    datagram.address = {peer.instance, peer.session, sequence};
    datagram.version = peer.version;
    datagram.force_n = to_array(command.force_n);
    datagram.torque_nm = to_array(command.torque_nm);
    datagram.gripper_force_n = command.gripper_force_n;
    datagram.state = command.state;
    datagram.answers = answers;
    ++counts_.forces;
    counts_.unsent += send(datagram, peer.endpoint) ? 0U : 1U;
}

bool UdpDevice::send(const udp::ForceDatagram& datagram, const udp::Endpoint& to) const noexcept
{
    return send_to(socket_, datagram, to, authenticator_);
}

/// Sends 0 in `answers`, since only the I/O thread knows the last accepted datagram.
void UdpDevice::brake() noexcept
{
    RemoteDevice::brake();
    udp::Peer peer;
    if (peer_.try_read(peer) && peer.is_attached)
    {
        udp::ForceDatagram datagram;
        datagram.address = {peer.instance, peer.session, sequence_.fetch_add(1) + 1};
        datagram.version = peer.version;
        datagram.state = DeviceState::brake;
        static_cast<void>(send(datagram, peer.endpoint)); // A lost brake is repeated.
    }
}

} // namespace tactus
