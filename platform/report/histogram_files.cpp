// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/histogram_folder.hpp"
#include "platform/report/report.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace tactus::hrtc
{

namespace
{

constexpr int kTicksPerHalf = 5;
/// Octaves of a LatencyHistogram: the first ends at 2,047 ns, each further one at twice that, the
/// last beyond kLongest.
constexpr int kOctaves = 27;
static_assert((LatencyHistogram::kLongest.ns >> (kOctaves - 1)) < LatencyHistogram::kSubBuckets &&
              (LatencyHistogram::kLongest.ns >> (kOctaves - 2)) >= LatencyHistogram::kSubBuckets);

/// Percentile to print after `share`, both from 0 to 1; the steps are smaller closer to 1.
double next_share(double share)
{
    const double halves = std::floor(std::log2(1.0 / (1.0 - share))) + 1.0;
    return share + 1.0 / (kTicksPerHalf * std::exp2(halves));
}

} // namespace

std::string hdr_text(const LatencyHistogram& histogram)
{
    std::string text = fmt::format("{:>12} {:>14} {:>10} {:>14}\n\n", "Value", "Percentile",
                                   "TotalCount", "1/(1-Percentile)");
    const std::uint64_t all = histogram.count();
    for (double share = 0.0; all > 0; share = next_share(share))
    {
        const Duration value = histogram.quantile(share);
        const std::uint64_t count = histogram.count_to(value);
        fmt::format_to(std::back_inserter(text), "{:12.3f} {:2.12f} {:10} {:14.2f}\n", to_us(value),
                       share, count, 1.0 / (1.0 - share));
        if (count == all)
        {
            fmt::format_to(std::back_inserter(text), "{:12.3f} {:2.12f} {:10}\n",
                           to_us(histogram.max()), 1.0, all);
            break;
        }
    }
    fmt::format_to(std::back_inserter(text),
                   "#[Mean    = {:12.3f}, StdDeviation   = {:12.3f}]\n"
                   "#[Max     = {:12.3f}, Total count    = {:12}]\n"
                   "#[Buckets = {:12}, SubBuckets     = {:12}]\n",
                   histogram.mean_ns() * 1e-3, histogram.standard_deviation_ns() * 1e-3,
                   to_us(histogram.max()), all, kOctaves, LatencyHistogram::kSubBuckets);
    return text;
}

std::optional<Refusal> write_histograms(const RunStatistics& statistics, const std::string& folder)
{
    for (const auto& [name, histogram] : statistics.times())
    {
        if (auto error = write_text(hdr_text(histogram), histogram_path(folder, name)))
        {
            return error;
        }
    }
    return std::nullopt;
}

} // namespace tactus::hrtc
