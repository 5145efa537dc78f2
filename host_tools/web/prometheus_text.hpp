// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/telemetry.hpp"

#include <string>
#include <utility>
#include <vector>

// Any thread: these are values; they allocate.
namespace tactus::web
{

/// Writes metrics in Prometheus' text format, version 0.0.4.
class PrometheusText
{
public:
    using Labels = std::vector<std::pair<const char*, std::string>>;

    /// Begins a metric, to which the following samples belong. `type` is "counter" or "gauge"; the
    /// name of a counter ends in _total. Each name may be used once.
    void family(const char* name, const char* type, const char* help);
    /// Adds a sample of the present metric. Values of labels may be any text.
    void sample(const Labels& labels, double value);

    [[nodiscard]] const std::string& text() const noexcept { return text_; }

private:
    std::string text_;
    const char* name_{""};
};

/// Adds the number of controllers, and the counters and gauges of each one.
void tell_controllers(PrometheusText& text,
                      const std::vector<const dds::WatchedController*>& controllers);

} // namespace tactus::web
