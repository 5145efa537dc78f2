// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "rt_core/base/result.hpp"
#include "transport/pose.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// What a line of a pose file holds; for messages.
inline constexpr std::string_view kPoseLineForm = "TIME_S NAME X Y Z QX QY QZ QW [SCALE]";
/// What takes the place of the pose where the object goes.
inline constexpr std::string_view kGoneWord = "gone";

/// Largest pose file, and the latest time in one.
inline constexpr std::size_t kPoseFileBytesMax = 64U << 20U;
inline constexpr double kPoseTimeMax_s = 1e6;

/// One line of a pose file, checked.
struct PoseLine
{
    double time_s{0.0};       ///< From the start of play.
    std::size_t object{0};    ///< Of the names.
    std::optional<Pose> pose; ///< None: it is gone from then on.
};

/// Reads a pose file's text: lines of kPoseLineForm in the order of their times; empty ones and
/// those that begin with # are passed over. `names` are the objects'. The error begins with
/// the line's number.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
parse_pose_lines(std::string_view text, std::span<const std::string> names);

/// The same for a file; the error begins with its name.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
read_pose_file(const std::filesystem::path& path, std::span<const std::string> names);

/// Plays lines in real time. Where several of one object are due only the newest is sent.
class PosePlayer
{
public:
    /// `lines` aren't empty; with `loops` the last one's time, where it begins anew, is above 0.
    PosePlayer(std::vector<PoseLine> lines, std::size_t objects, bool loops);

    /// The newest line that is due and was not given yet, of each object; `now_s` never falls.
    [[nodiscard]] std::vector<PoseLine> take_due(double now_s);

    /// When the next line is due; none when all have been played.
    [[nodiscard]] std::optional<double> next_s() const;

private:
    std::vector<PoseLine> lines_;
    std::size_t objects_;
    bool loops_;
    double round_start_s_{0.0};
    std::size_t next_{0};
};

} // namespace tactus
