// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "tests/relay/relay.hpp"
#include "tests/relay/tap_network.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <poll.h>
#include <string>
#include <sys/prctl.h>
#include <unistd.h>

namespace tactus::relay
{

namespace
{

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
