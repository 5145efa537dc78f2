// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <string>

// Ordinary thread, because it reads a file.
namespace tactus::hrtc
{

/// Authenticator with the key in this file: 64 hexadecimal digits, with white space around them.
/// Tags are keyed BLAKE2b (RFC 7693) of 16 bytes. Refused if the file can't be read, has other
/// contents, or may be read by users besides its owner and group.
[[nodiscard]] Result<std::shared_ptr<const udp::Authenticator>, Refusal>
read_device_key(const std::string& path);

} // namespace tactus::hrtc
