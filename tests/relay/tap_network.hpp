// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tactus::relay
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

} // namespace tactus::relay
