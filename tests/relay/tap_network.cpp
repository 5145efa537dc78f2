// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/tap_network.hpp"

#include "rt_core/base/assert.hpp"

#include <fmt/format.h>

#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <optional>
#include <sched.h>
#include <sstream>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace tactus::relay
{

namespace
{

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

} // namespace

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

} // namespace tactus::relay
