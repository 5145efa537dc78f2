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

/// Lays out metrics in Prometheus' text format, version 0.0.4.
class PrometheusText
{
public:
    using Labels = std::vector<std::pair<const char*, std::string>>;

    /// What samples are of until the next call. `type` is counter or gauge; a counter's name ends
    /// in _total. Each name once.
    void family(const char* name, const char* type, const char* help);
    /// A label's value may hold anything.
    void sample(const Labels& labels, double value);

    [[nodiscard]] const std::string& text() const noexcept { return text_; }

private:
    std::string text_;
    const char* name_{""};
};

/// How many controllers there are, and counts and gauges of each.
void tell_controllers(PrometheusText& text,
                      const std::vector<const dds::WatchedController*>& controllers);

} // namespace tactus::web
