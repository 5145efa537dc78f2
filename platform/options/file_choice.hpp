// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "platform/options/option_table.hpp"
#include "platform/options/options.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <string>

namespace tactus::hrtc
{

/// True if the text is a path, or the name of a model or scene file.
[[nodiscard]] bool is_file_name(const std::string& text, const FileReaders& readers);

/// Takes files without an option on the command line as values of --model or --scene. Without
/// --transport, chooses the transport: `file` if all names are files, `dds` if none is. Returns the
/// message for wrong usage; empty if there is none. `commands`: names of the program's other
/// commands, for that message.
[[nodiscard]] std::string assign_files(Options& options, RawOptions& raw,
                                       const std::string& commands);

/// Authenticator with the key in this file: 64 hexadecimal digits, with white space around them.
/// Tags are keyed BLAKE2b (RFC 7693) of 16 bytes. Refused if the file can't be read, has other
/// contents, or may be read by users besides its owner and group.
[[nodiscard]] Result<std::shared_ptr<const udp::Authenticator>, Refusal>
read_device_key(const std::string& path);

} // namespace tactus::hrtc
