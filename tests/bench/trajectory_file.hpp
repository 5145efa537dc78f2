// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Reads .traj streams of positions and forces as the Haptic Data Repository has them (Ruffaldi,
/// Morris, Edmunds, Barbagli and Pai, Standardized Evaluation of Haptic Rendering Systems, 2006).
///
/// What is accepted:
///
///     file    = { comment | title } sample { sample | comment }
///     comment = a line without a token, or one whose first character is # or %
///     title   = before the first sample only, at most kMaxTitleLines: a line whose first token is
///               not a number
///     sample  = as many numbers as there are columns, in their order, blanks or tabs between them
///
/// Lines end in LF or CR LF, the last one too: a file that was cut within a line is refused. Times
/// ascend. The repository's own page of the columns' order and units is not at hand, so both are
/// told by the caller.
namespace tactus::bench
{

inline constexpr std::size_t kMaxTitleLines = 16;
inline constexpr std::size_t kMaxTrajectoryColumns = 32;
inline constexpr std::size_t kMinSamples = 2;
inline constexpr std::size_t kMaxSamples = 10'000'000;
inline constexpr std::uintmax_t kMaxTrajectoryBytes = std::uintmax_t{1} << 30U;
/// Greater amounts are no force of a device.
inline constexpr double kMaxTrajectoryForce_n = 1e6;

struct TrajectoryError
{
    std::string text; ///< One line; the file or option, the line, what is wrong, what is allowed.
};

/// What stands in which column of a sample.
class TrajectoryColumns
{
public:
    /// Names with commas between them: t in seconds; x, y, z; fx, fy, fz in newtons, or fn alone
    /// where only the force's amount was kept; _ for one to pass over. A minus in front turns the
    /// sign. Each but _ once; t and all of a position and a force must be there.
    [[nodiscard]] static Result<TrajectoryColumns, TrajectoryError> parse(std::string_view text);

    [[nodiscard]] std::size_t count() const { return quantities_.size(); }
    /// Of fn only the amount is known.
    [[nodiscard]] bool has_force_direction() const { return has_force_direction_; }

    /// Which of t, x, y, z, fx, fy, fz a column is, fn in the place of fx; kNone for none of them.
    static constexpr std::size_t kQuantities = 7;
    static constexpr std::size_t kNone = kQuantities;
    struct Quantity
    {
        std::size_t index{kNone};
        double sign{1.0};
    };
    [[nodiscard]] const Quantity& quantity(std::size_t column) const { return quantities_[column]; }

private:
    TrajectoryColumns() = default;

    std::vector<Quantity> quantities_;
    bool has_force_direction_{true};
};

struct TrajectorySample
{
    double time_s{0.0};
    Vec3 position_m{0.0, 0.0, 0.0};
    /// Where there is no direction: its amount along x.
    Vec3 force_n{0.0, 0.0, 0.0};
};

struct Trajectory
{
    std::vector<TrajectorySample> samples;
    bool has_force_direction{true};

    [[nodiscard]] double duration_s() const
    {
        return samples.back().time_s - samples.front().time_s;
    }
};

/// Guarantees of a trajectory: kMinSamples .. kMaxSamples samples, times that ascend, every number
/// finite, coordinates within kGoalRange_m, forces within kMaxTrajectoryForce_n. Errors begin with
/// the line's number, from 1.
[[nodiscard]] Result<Trajectory, TrajectoryError>
parse_trajectory(std::string_view text, const TrajectoryColumns& columns, double metres_per_unit);

/// The same of a file, whose name stands before the error.
[[nodiscard]] Result<Trajectory, TrajectoryError> read_trajectory(const std::filesystem::path& path,
                                                                  const TrajectoryColumns& columns,
                                                                  double metres_per_unit);

} // namespace tactus::bench
