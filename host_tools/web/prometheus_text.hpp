// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/telemetry.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

// Any thread: values; they allocate.
namespace tactus::web
{

/// Writes metrics in Prometheus' text format, version 0.0.4.
class PrometheusText
{
public:
    using Labels = std::vector<std::pair<const char*, std::string>>;

    /// Starts a metric; the following samples belong to it. `type` is counter or gauge; a counter's
    /// name ends in _total. Each name once.
    void family(const char* name, const char* type, const char* help);
    /// Adds a sample. Values of labels may contain any text.
    void sample(const Labels& labels, double value);

    [[nodiscard]] const std::string& text() const noexcept { return text_; }

private:
    std::string text_;
    const char* name_{""};
};

/// Adds the number of controllers, and counters and gauges of each.
void tell_controllers(PrometheusText& text,
                      const std::vector<const dds::WatchedController*>& controllers);

} // namespace tactus::web
