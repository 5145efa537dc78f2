// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <utility>

namespace tactus::hrtc
{

/// A word of the summary and the verdict, and what it means.
using ReportWord = std::pair<const char*, const char*>;

/// All that a reader of the page may not know: answers, times, causes of a force that went off.
[[nodiscard]] std::span<const ReportWord> report_words() noexcept;

} // namespace tactus::hrtc
