// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tactus::dds
{

/// Cyclone 0.10 binds the sockets that it receives by to all interfaces, whichever it is told to
/// use. Calls `open_sockets` and binds the UDP sockets that are open then, were not before and
/// receive from every interface to the loopback device: nothing from outside arrives there. Returns
/// why that failed. No other thread may open such a socket meanwhile. Linux only; elsewhere the
/// sockets stay as they are.
[[nodiscard]] std::optional<std::string>
opened_on_loopback(const std::function<void()>& open_sockets);

} // namespace tactus::dds
