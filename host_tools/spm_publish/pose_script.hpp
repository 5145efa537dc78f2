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

/// Form of a line with a pose, for messages.
inline constexpr std::string_view kPoseLineForm = "TIME_S NAME X Y Z QX QY QZ QW [SCALE]";
/// Word in place of the pose in a line that removes the object.
inline constexpr std::string_view kGoneWord = "gone";
/// Word in place of the pose in a line that changes the material, and the form of such a line.
inline constexpr std::string_view kMaterialWord = "material";
inline constexpr std::string_view kMaterialLineForm = "TIME_S NAME material KEY=VALUE[,...]";

/// Maximum size of a pose file, and maximum time in it.
inline constexpr std::size_t kPoseFileBytesMax = 64U << 20U;
inline constexpr double kPoseTimeMax_s = 1e6;

/// One valid line of a pose file.
struct PoseLine
{
    double time_s{0.0};    ///< Time since the start of play.
    std::size_t object{0}; ///< Index into the objects given to the parser.
    /// New pose, if any. A line without pose and material removes the object.
    std::optional<Pose> pose;
    /// New material, if any; then there is no pose, and the pose stays.
    std::optional<Material> material;
};

/// An object that the lines of a pose file may name.
struct ScriptedObject
{
    std::string name;
    double scale{1.0}; ///< Scale until the first line with a SCALE.
};

/// Parses the text of a pose file. Lines have the forms above, ascending by time; empty lines and
/// lines that begin with # are ignored. A pose without SCALE keeps the object's scale. A refusal
/// begins with the number of the line.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
parse_pose_lines(std::string_view text, std::span<const ScriptedObject> objects);

/// Reads and parses a pose file; a refusal begins with the path.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
read_pose_file(const std::filesystem::path& path, std::span<const ScriptedObject> objects);

/// Maximum number of lines that interpolated() returns.
inline constexpr std::size_t kInterpolatedLinesMax = 2'000'000;
/// Range of rates for interpolated(), in Hz.
inline constexpr double kPosesRateMin_hz = 1.0;
inline constexpr double kPosesRateMax_hz = 1'000.0;

/// Adds poses between successive poses of each object, `rate_hz` a second: translation and scale
/// linear, rotation the shortest way at constant speed. None are added while an object is removed.
/// Refused above kInterpolatedLinesMax lines.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
interpolated(std::span<const PoseLine> lines, std::size_t objects, double rate_hz);

/// Plays the lines of a pose file in real time. If several lines of an object are due, only its
/// newest pose and newest material are returned.
class PosePlayer
{
public:
    /// `lines` must not be empty. If `loops`, play restarts at the time of the last line, which
    /// must be above 0.
    PosePlayer(std::vector<PoseLine> lines, std::size_t objects, bool loops);

    /// Takes the lines that are due at `now_s`, for each object at most a material and then a pose.
    /// `now_s` must not decrease.
    [[nodiscard]] std::vector<PoseLine> take_due(double now_s);

    /// Time of the next line; none after the last one.
    [[nodiscard]] std::optional<double> next_s() const;

private:
    std::vector<PoseLine> lines_;
    std::size_t objects_;
    bool loops_;
    double round_start_s_{0.0};
    std::size_t next_{0};
};

} // namespace tactus
