// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/time.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/result.hpp"
#include "tests/relay/one_way.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <sched.h>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::relay
{
namespace
{

struct TapOptions
{
    std::string interface; ///< Name, at most 15 characters.
    std::string address;   ///< IPv4 address; its network has 24 bits.
    int mtu_bytes{1'500};
};

struct TapError
{
    std::string text;
};

/// Network namespace with one interface besides `lo`, whose other end is here. It has no name and
/// exists as long as this object, or a process in it: others enter it by `nsenter
/// --net=/proc/PID/fd/N` with this process and namespace_descriptor(). IPv6 is off, so that only
/// programs send.
class TapNetwork
{
public:
    /// Creates namespace and interface, both up; the calling thread returns to its own namespace.
    /// Needs CAP_SYS_ADMIN, CAP_NET_ADMIN and /dev/net/tun; otherwise reports what was refused.
    [[nodiscard]] static Result<TapNetwork, TapError> create(const TapOptions& options);

    TapNetwork(TapNetwork&& other) noexcept;
    TapNetwork& operator=(TapNetwork&&) = delete;
    ~TapNetwork();

    [[nodiscard]] int namespace_descriptor() const { return namespace_; }
    /// Descriptor to wait for frames from the network.
    [[nodiscard]] int tap_descriptor() const { return tap_; }

    /// Reads the next whole frame from the network; returns its size, 0 if there is none.
    [[nodiscard]] std::size_t read(std::span<std::byte> buffer) const;

    /// Frames from the network that the system dropped because they were not read in time.
    [[nodiscard]] std::uint64_t frames_missed() const;

    /// Sends a frame to the network. False if the system refused it.
    [[nodiscard]] bool write(std::span<const std::byte> frame) const;

private:
    TapNetwork(const std::string& interface, int network, int tap, int statistics)
        : interface_(interface), namespace_(network), tap_(tap), statistics_(statistics)
    {
    }

    std::string interface_;
    int namespace_;
    int tap_;
    int statistics_; ///< Statistics of the interfaces of the namespace in which it was opened.
};

constexpr const char* kTunDevice = "/dev/net/tun";
constexpr const char* kOwnNamespace = "/proc/thread-self/ns/net";
constexpr const char* kStatistics = "/proc/thread-self/net/dev";
constexpr const char* kNetmask = "255.255.255.0";
/// Frames that the system keeps until the relay reads them: a hundred milliseconds of large ones at
/// 500 Mbit/s. frames_missed() counts further ones.
constexpr int kSystemQueueFrames = 4'096;

/// Descriptor, closed by the destructor unless released.
class Descriptor
{
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor()
    {
        if (number_ >= 0)
        {
            close(number_);
        }
    }

    [[nodiscard]] int get() const { return number_; }
    [[nodiscard]] int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

TapError refusal(const std::string& what)
{
    return {fmt::format("{}: {}", what, std::strerror(errno))};
}

/// Guard that returns the thread to this namespace.
class NamespaceReturn
{
public:
    explicit NamespaceReturn(int home) : home_(home) {}
    NamespaceReturn(const NamespaceReturn&) = delete;
    NamespaceReturn& operator=(const NamespaceReturn&) = delete;
    ~NamespaceReturn() { static_cast<void>(setns(home_, CLONE_NEWNET)); }

private:
    int home_;
};

ifreq request_for(const std::string& interface)
{
    ifreq request{};
    interface.copy(static_cast<char*>(request.ifr_name), IFNAMSIZ - 1);
    return request;
}

sockaddr to_system(const std::string& address)
{
    sockaddr_in parsed{};
    parsed.sin_family = AF_INET;
    inet_pton(AF_INET, address.c_str(), &parsed.sin_addr);
    sockaddr any{};
    static_assert(sizeof(any) == sizeof(parsed));
    std::memcpy(&any, &parsed, sizeof(any));
    return any;
}

bool turn_on(int socket, const std::string& interface)
{
    ifreq request = request_for(interface);
    if (ioctl(socket, SIOCGIFFLAGS, &request) != 0)
    {
        return false;
    }
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
    return ioctl(socket, SIOCSIFFLAGS, &request) == 0;
}

/// No effect without IPv6.
void turn_ipv6_off()
{
    for (const char* whose : {"all", "default"})
    {
        const std::string path = fmt::format("/proc/sys/net/ipv6/conf/{}/disable_ipv6", whose);
        const Descriptor file(open(path.c_str(), O_WRONLY | O_CLOEXEC));
        [[maybe_unused]] const auto written = ::write(file.get(), "1", 1);
    }
}

/// Sets address, MTU and queue in the thread's namespace and enables the interface. Returns what
/// was refused, if anything.
std::optional<TapError> set_up(const TapOptions& options)
{
    const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (socket.get() < 0)
    {
        return refusal("a socket");
    }
    ifreq address = request_for(options.interface);
    address.ifr_addr = to_system(options.address);
    ifreq netmask = request_for(options.interface);
    netmask.ifr_netmask = to_system(kNetmask);
    ifreq mtu = request_for(options.interface);
    mtu.ifr_mtu = options.mtu_bytes;
    ifreq queue = request_for(options.interface);
    queue.ifr_qlen = kSystemQueueFrames;
    if (ioctl(socket.get(), SIOCSIFADDR, &address) != 0 ||
        ioctl(socket.get(), SIOCSIFNETMASK, &netmask) != 0)
    {
        return refusal("the address of " + options.interface);
    }
    if (ioctl(socket.get(), SIOCSIFMTU, &mtu) != 0 ||
        ioctl(socket.get(), SIOCSIFTXQLEN, &queue) != 0)
    {
        return refusal("MTU and queue of " + options.interface);
    }
    if (!turn_on(socket.get(), "lo") || !turn_on(socket.get(), options.interface))
    {
        return refusal("turning on lo and " + options.interface);
    }
    return std::nullopt;
}

Result<TapNetwork, TapError> TapNetwork::create(const TapOptions& options)
{
    const Descriptor home(open(kOwnNamespace, O_RDONLY | O_CLOEXEC));
    if (home.get() < 0)
    {
        return refusal(kOwnNamespace);
    }
    const NamespaceReturn on_return(home.get());
    if (unshare(CLONE_NEWNET) != 0)
    {
        return refusal("a network namespace");
    }
    Descriptor network(open(kOwnNamespace, O_RDONLY | O_CLOEXEC));
    if (network.get() < 0)
    {
        return refusal(kOwnNamespace);
    }
    Descriptor statistics(open(kStatistics, O_RDONLY | O_CLOEXEC));
    if (statistics.get() < 0)
    {
        return refusal(kStatistics);
    }
    Descriptor tap(open(kTunDevice, O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (tap.get() < 0)
    {
        return refusal(kTunDevice);
    }
    ifreq request = request_for(options.interface);
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    if (ioctl(tap.get(), TUNSETIFF, &request) != 0)
    {
        return refusal("a TAP device");
    }
    turn_ipv6_off();
    if (const std::optional<TapError> refused = set_up(options))
    {
        return *refused;
    }
    return TapNetwork(options.interface, network.release(), tap.release(), statistics.release());
}

TapNetwork::TapNetwork(TapNetwork&& other) noexcept
    : interface_(std::move(other.interface_))
    , namespace_(std::exchange(other.namespace_, -1))
    , tap_(std::exchange(other.tap_, -1))
    , statistics_(std::exchange(other.statistics_, -1))
{
}

TapNetwork::~TapNetwork()
{
    for (const int descriptor : {tap_, namespace_, statistics_})
    {
        if (descriptor >= 0)
        {
            close(descriptor);
        }
    }
}

std::size_t TapNetwork::read(std::span<std::byte> buffer) const
{
    const ssize_t bytes = ::read(tap_, buffer.data(), buffer.size());
    return bytes < 0 ? 0 : static_cast<std::size_t>(bytes);
}

std::uint64_t TapNetwork::frames_missed() const
{
    // Fourth of the sent columns in "interface: 8 received columns, 8 sent columns".
    constexpr int kColumn = 12;
    std::array<char, 4'096> text{};
    const ssize_t bytes = ::pread(statistics_, text.data(), text.size(), 0);
    TACTUS_ASSERT(bytes > 0);
    std::istringstream lines(std::string(text.data(), static_cast<std::size_t>(bytes)));
    for (std::string word; lines >> word;)
    {
        if (word != interface_ + ":")
        {
            continue;
        }
        std::uint64_t figure = 0;
        for (int column = 0; column < kColumn; ++column)
        {
            lines >> figure;
        }
        return figure;
    }
    TACTUS_ASSERT(false); // The interface exists as long as this object.
    return 0;
}

bool TapNetwork::write(std::span<const std::byte> frame) const
{
    return ::write(tap_, frame.data(), frame.size()) == static_cast<ssize_t>(frame.size());
}

/// Relay of frames between two networks. One thread.
class Relay
{
public:
    /// Connects both networks, which must outlive it. Each direction has its own random numbers
    /// from `seed`.
    Relay(const TapNetwork& server, const TapNetwork& controller, const LinkCondition& condition,
          std::uint64_t seed);

    /// Takes all frames sent by both networks and delivers those due at the clock's time.
    void carry();

    /// Time of the next delivery; empty if no frame is in transit.
    [[nodiscard]] std::optional<MonotonicTime> next_due() const;

    /// Executes a line. The answer is one line: "done", "refused: " with the allowed forms, or the
    /// counts as JSON. These are OneWayCounts of each direction, `missed`, frames that the system
    /// dropped before they could be read, and `refused_by_system`, those that it did not accept.
    [[nodiscard]] std::string answer(std::string_view line);

private:
    struct Direction
    {
        const TapNetwork* from;
        const TapNetwork* to;
        OneWay way;
        std::uint64_t refused_by_system{0};
    };

    void collect(Direction& direction);
    static void deliver(Direction& direction);
    void follow(const Command& command);
    [[nodiscard]] std::string counts() const;

    Direction to_controller_;
    Direction to_server_;
    LinkCondition condition_;
    std::vector<std::byte> buffer_;
};

using Json = nlohmann::ordered_json;

/// Size for the largest MTU of main.cpp with headers of all kinds.
constexpr std::size_t kFrameBytesMax = std::size_t{16} << 10U;
/// Frames taken from one network before the other's turn and the delivery of due ones.
constexpr int kFramesInTurn = 64;

Json json_of(const OneWayCounts& counts, std::uint64_t missed, std::uint64_t refused_by_system)
{
    return {{"frames", counts.frames},
            {"bytes", counts.bytes},
            {"udp_datagrams", counts.udp_datagrams},
            {"udp_payload_bytes", counts.udp_payload_bytes},
            {"delivered", counts.delivered},
            {"lost", counts.lost},
            {"duplicated", counts.duplicated},
            {"cut", counts.cut},
            {"dropped_full", counts.dropped_full},
            {"missed", missed},
            {"refused_by_system", refused_by_system}};
}

MonotonicTime now()
{
    return PosixClock().now();
}

Relay::Relay(const TapNetwork& server, const TapNetwork& controller, const LinkCondition& condition,
             std::uint64_t seed)
    : to_controller_{&server, &controller, OneWay(2 * seed)}
    , to_server_{&controller, &server, OneWay(2 * seed + 1)}
    , condition_(condition)
    , buffer_(kFrameBytesMax)
{
}

void Relay::carry()
{
    collect(to_controller_);
    collect(to_server_);
    deliver(to_controller_);
    deliver(to_server_);
}

void Relay::collect(Direction& direction)
{
    for (int i = 0; i < kFramesInTurn; ++i)
    {
        const std::size_t bytes = direction.from->read(buffer_);
        if (bytes == 0)
        {
            return;
        }
        direction.way.take(std::span(buffer_).first(bytes), condition_, now());
    }
}

void Relay::deliver(Direction& direction)
{
    const MonotonicTime until = now();
    while (const auto frame = direction.way.take_due(until))
    {
        direction.refused_by_system += direction.to->write(*frame) ? 0U : 1U;
    }
}

std::optional<MonotonicTime> Relay::next_due() const
{
    const std::optional<MonotonicTime> one = to_controller_.way.next_due();
    const std::optional<MonotonicTime> other = to_server_.way.next_due();
    return one && other ? std::min(one, other) : (one ? one : other);
}

std::string Relay::answer(std::string_view line)
{
    const std::optional<Command> command = parse_command(line);
    if (!command)
    {
        return "refused: allowed are " + command_forms();
    }
    if (std::holds_alternative<Count>(*command))
    {
        return counts();
    }
    follow(*command);
    return "done";
}

void Relay::follow(const Command& command)
{
    if (const auto* set = std::get_if<Set>(&command))
    {
        condition_.*set->figure = set->value;
        return;
    }
    if (const auto* cut = std::get_if<Cut>(&command))
    {
        if (cut->to_controller)
        {
            to_controller_.way.cut();
        }
        if (cut->to_server)
        {
            to_server_.way.cut();
        }
        return;
    }
    to_controller_.way.restore();
    to_server_.way.restore();
}

std::string Relay::counts() const
{
    const auto side = [](const Direction& direction)
    {
        return json_of(direction.way.counts(), direction.from->frames_missed(),
                       direction.refused_by_system);
    };
    return Json{{"to_controller", side(to_controller_)}, {"to_server", side(to_server_)}}.dump();
}

constexpr int kMtuMin_bytes = 576; // Least MTU of an IPv4 server.
constexpr int kMtuMax_bytes = 9'000;
constexpr std::size_t kLineBytesMax = 200;
constexpr const char* kServerAddress = "10.77.0.1";
constexpr const char* kControllerAddress = "10.77.0.2";

struct Options
{
    LinkCondition condition;
    std::uint32_t seed{1};
    int mtu_bytes{1'500};
};

volatile std::sig_atomic_t stop_requested = 0;

/// Blocks the signals except during the loop's wait, so that none is missed between its check and
/// its wait.
void stop_on_signals(sigset_t& while_waiting)
{
    struct sigaction action = {};
    action.sa_handler = [](int) { stop_requested = 1; };
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = SIG_IGN; // A closed reader of the answers is detected by the write.
    ::sigaction(SIGPIPE, &action, nullptr);
    sigset_t blocked;
    ::sigemptyset(&blocked);
    ::sigaddset(&blocked, SIGINT);
    ::sigaddset(&blocked, SIGTERM);
    ::sigprocmask(SIG_BLOCK, &blocked, &while_waiting);
    ::sigdelset(&while_waiting, SIGINT);
    ::sigdelset(&while_waiting, SIGTERM);
}

void declare_options(CommandLine& line, Options& options)
{
    line.add_version("network_relay " TACTUS_VERSION);
    line.add_option("--delay-ms", options.condition.delay_ms, "Delay of every frame, one way")
        .number_between(0.0, kDelayMax_ms)
        .show_default();
    line.add_option("--jitter-ms", options.condition.jitter_ms,
                    "On top of it, uniform from 0 to this; frames overtake each other")
        .number_between(0.0, kDelayMax_ms)
        .show_default();
    line.add_option("--loss", options.condition.loss, "Share of the frames that are lost")
        .number_between(0.0, 1.0)
        .show_default();
    line.add_option("--duplicates", options.condition.duplicates,
                    "Share of the others that arrive twice")
        .number_between(0.0, 1.0)
        .show_default();
    line.add_option("--seed", options.seed, "Of all random choices")
        .integer_between(std::uint32_t{0}, std::numeric_limits<std::uint32_t>::max())
        .show_default();
    line.add_option("--mtu", options.mtu_bytes, "Of both interfaces, in bytes")
        .integer_between(kMtuMin_bytes, kMtuMax_bytes)
        .show_default();
}

/// Prints a line; false if the reader is gone.
bool say(const std::string& line)
{
    return std::puts(line.c_str()) >= 0 && std::fflush(stdout) == 0;
}

/// DDS configuration of a network by docs/two-machines.md; without a double quote, so that it fits
/// into JSON.
std::string dds_configuration(const char* interface)
{
    return fmt::format(
        "<CycloneDDS><Domain id='any'><General>"
        "<Interfaces><NetworkInterface name='{}' multicast='false'/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast><MaxMessageSize>1400B</MaxMessageSize>"
        "<FragmentSize>1300B</FragmentSize></General>"
        "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>99</MaxAutoParticipantIndex><LeaseDuration>1 s</LeaseDuration>"
        "<Peers><Peer address='{}'/><Peer address='{}'/></Peers></Discovery>"
        "<Internal><HeartbeatInterval min='2 ms' minsched='2 ms' max='20 ms'>5 ms"
        "</HeartbeatInterval><NackDelay>1 ms</NackDelay><PreEmptiveAckDelay>2 ms"
        "</PreEmptiveAckDelay><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>"
        "</Domain></CycloneDDS>",
        interface, kServerAddress, kControllerAddress);
}

std::string ready_line(const TapNetwork& server, const TapNetwork& controller)
{
    const auto side = [](const TapNetwork& network, const char* interface, const char* address)
    {
        return nlohmann::ordered_json{{"fd", network.namespace_descriptor()},
                                      {"interface", interface},
                                      {"address", std::string(address) + "/24"},
                                      {"dds", dds_configuration(interface)}};
    };
    return nlohmann::ordered_json{
        {"pid", ::getpid()},
        {"server", side(server, "server0", kServerAddress)},
        {"controller", side(controller, "controller0", kControllerAddress)}}
        .dump();
}

/// Lines of stdin as they arrive.
class CommandLines
{
public:
    /// Reads once and answers each whole line. False at the end of the file, for a line that is too
    /// long, or if the reader of the answers is gone.
    bool answer_by(Relay& relay)
    {
        std::array<char, kLineBytesMax> bytes{};
        const ssize_t read = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        if (read <= 0)
        {
            return false;
        }
        text_.append(bytes.data(), static_cast<std::size_t>(read));
        for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n'))
        {
            if (!say(relay.answer(text_.substr(0, end))))
            {
                return false;
            }
            text_.erase(0, end + 1);
        }
        return text_.size() <= kLineBytesMax;
    }

private:
    std::string text_;
};

timespec wait_time(MonotonicTime due)
{
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    const std::int64_t left_ns = std::max<std::int64_t>((due - PosixClock().now()).ns, 0);
    return {left_ns / kSecond_ns, left_ns % kSecond_ns};
}

void serve(Relay& relay, const TapNetwork& server, const TapNetwork& controller,
           const sigset_t& while_waiting)
{
    CommandLines lines;
    std::array<pollfd, 3> awaited{{{STDIN_FILENO, POLLIN, 0},
                                   {server.tap_descriptor(), POLLIN, 0},
                                   {controller.tap_descriptor(), POLLIN, 0}}};
    while (stop_requested == 0)
    {
        const std::optional<MonotonicTime> due = relay.next_due();
        const timespec wait = due ? wait_time(*due) : timespec{};
        const int ready =
            ::ppoll(awaited.data(), awaited.size(), due ? &wait : nullptr, &while_waiting);
        relay.carry();
        if (ready > 0 && awaited[0].revents != 0 && !lines.answer_by(relay))
        {
            return;
        }
    }
}

int run(int argc, char** argv)
{
    CommandLine line("network_relay",
                     "Makes two networks and carries frames between them, with delay, loss, "
                     "duplicates and cuts; told on stdin: " +
                         command_forms() + ".");
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    const auto server = TapNetwork::create({"server0", kServerAddress, options.mtu_bytes});
    if (!server)
    {
        return line.fail("no network can be made here: " + server.error().text);
    }
    const auto controller =
        TapNetwork::create({"controller0", kControllerAddress, options.mtu_bytes});
    if (!controller)
    {
        return line.fail("no network can be made here: " + controller.error().text);
    }
    // The system by default wakes a sleeper up to 50 us late, to save power.
    static_cast<void>(::prctl(PR_SET_TIMERSLACK, 1UL));
    sigset_t while_waiting;
    stop_on_signals(while_waiting);
    Relay relay(server.value(), controller.value(), options.condition, options.seed);
    if (say(ready_line(server.value(), controller.value())))
    {
        serve(relay, server.value(), controller.value(), while_waiting);
    }
    return kExitDone;
}

} // namespace

} // namespace tactus::relay

int main(int argc, char** argv)
{
    return tactus::run_program("network_relay", "", [&] { return tactus::relay::run(argc, argv); });
}
