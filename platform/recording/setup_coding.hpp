// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording_format.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/spm/header.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Content of the setup section: everything except the models, of which it holds the number.
[[nodiscard]] std::vector<std::byte> code_setup(const RecordedSetup& setup);
/// Content of one model section.
[[nodiscard]] std::vector<std::byte> code_model(const RecordedModel& model);

/// Content of a name section; a name that is too long is cut.
[[nodiscard]] std::vector<std::byte> code_name(const RecordedName& what, std::string_view name);

/// Reads a setup section and the number of models that follow. Returns the fault, if any.
[[nodiscard]] std::optional<std::string> parse_setup(std::span<const std::byte> payload,
                                                     RecordedSetup& setup, std::uint32_t& models);
/// Reads a model section and its counts. `bytes_left`: bytes that the pools may still take; reduced
/// by this model's. Returns the fault, if any.
[[nodiscard]] std::optional<std::string> parse_model(std::span<const std::byte> payload,
                                                     bool has_streamed_models, RecordedModel& model,
                                                     ModelCounts& counts, std::size_t& bytes_left);

/// Reads a name section into the names of the setup, whose models were read. Returns the fault, if
/// any.
[[nodiscard]] std::optional<std::string> parse_name(std::span<const std::byte> payload,
                                                    RecordedSetup& setup);

/// Fault if a section's content ends before or after its payload.
[[nodiscard]] std::optional<std::string> unless_whole(const ByteReader& reader,
                                                      const char* section);

} // namespace tactus
