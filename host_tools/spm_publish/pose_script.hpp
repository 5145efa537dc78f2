// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/records/material.hpp"
#include "transport/base/refusal.hpp"
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
/// What takes its place where the object feels otherwise, and what follows it.
inline constexpr std::string_view kMaterialWord = "material";
inline constexpr std::string_view kMaterialLineForm = "TIME_S NAME material KEY=VALUE[,...]";

/// Largest pose file, and the latest time in one.
inline constexpr std::size_t kPoseFileBytesMax = 64U << 20U;
inline constexpr double kPoseTimeMax_s = 1e6;

/// One line of a pose file, checked.
struct PoseLine
{
    double time_s{0.0};               ///< From the start of play.
    std::size_t object{0};            ///< Index among the objects that lines may name.
    std::optional<Pose> pose;         ///< None: it is gone from then on, or
    std::optional<Material> material; ///< feels so, and stands where it stood.
};

/// An object that lines may name.
struct ScriptedObject
{
    std::string name;
    double scale{1.0}; ///< Which it has until a line says another.
};

/// Reads a pose file's text: lines of these forms in the order of their times; empty ones and
/// those that begin with # are passed over. A pose without SCALE has that of the object's line
/// before, or its first. The error begins with the line's number.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
parse_pose_lines(std::string_view text, std::span<const ScriptedObject> objects);

/// The same for a file; the error begins with its name.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
read_pose_file(const std::filesystem::path& path, std::span<const ScriptedObject> objects);

/// Most lines that `interpolated` makes.
inline constexpr std::size_t kInterpolatedLinesMax = 2'000'000;
/// Rates of it, in Hz.
inline constexpr double kPosesRateMin_hz = 1.0;
inline constexpr double kPosesRateMax_hz = 1'000.0;

/// Lines between those of each object that follow one another, `rate_hz` a second: places and
/// scales on straight lines, rotations by the shortest way at an even speed. Nothing is put between
/// lines where the object is gone. Refused where that makes more than kInterpolatedLinesMax.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
interpolated(std::span<const PoseLine> lines, std::size_t objects, double rate_hz);

/// Plays lines in real time. Where several of one object are due only the newest of where it stands
/// and the newest of how it feels are sent.
class PosePlayer
{
public:
    /// `lines` aren't empty; with `loops` the last one's time, where it begins anew, is above 0.
    PosePlayer(std::vector<PoseLine> lines, std::size_t objects, bool loops);

    /// The newest lines that are due and were not given yet: of each object how it feels, then
    /// where it stands. `now_s` never falls.
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
