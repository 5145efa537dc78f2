// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cmath>
#include <cstdint>

namespace tactus
{

/// Frames from a request to the piece's arrival: a smoothed mean and mean deviation, as RFC 6298
/// estimates a round trip.
class LoadLatency
{
public:
    void add(std::uint32_t frames) noexcept
    {
        const auto waited = static_cast<double>(frames);
        if (!is_measured_)
        {
            mean_ = waited;
            deviation_ = 0.5 * waited;
            is_measured_ = true;
            return;
        }
        deviation_ += 0.25 * (std::abs(waited - mean_) - deviation_);
        mean_ += 0.125 * (waited - mean_);
    }

    [[nodiscard]] double mean_frames() const noexcept { return mean_; }
    /// Number of frames within which nearly all pieces arrive.
    [[nodiscard]] double most_frames() const noexcept { return mean_ + 2.0 * deviation_; }
    /// True once a piece has arrived; before that the values are those of a local network at 1 kHz.
    [[nodiscard]] bool is_measured() const noexcept { return is_measured_; }

private:
    double mean_{10.0};
    double deviation_{5.0};
    bool is_measured_{false};
};

} // namespace tactus
