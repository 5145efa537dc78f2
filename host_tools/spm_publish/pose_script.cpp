// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/pose_script.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/material_text.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::size_t kFieldsMin = 9;
constexpr std::size_t kFieldsMax = 10;
constexpr std::string_view kSpaces = " \t";

/// Fields of a line; at most one more than allowed, which shows an excess.
std::vector<std::string_view> fields_of(std::string_view line)
{
    std::vector<std::string_view> fields;
    while (fields.size() <= kFieldsMax)
    {
        const std::size_t begin = line.find_first_not_of(kSpaces);
        if (begin == std::string_view::npos)
        {
            break;
        }
        const std::size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
        fields.push_back(line.substr(begin, end - begin));
        line.remove_prefix(end);
    }
    return fields;
}

std::string refusal_text(PoseRefusal refusal)
{
    switch (refusal)
    {
    case PoseRefusal::rotation:
        return fmt::format("QX QY QZ QW must have a length within {} of 1", kPoseUnitTolerance);
    case PoseRefusal::translation:
        return fmt::format("X Y Z must be {} to {} m", -kPoseReachMax_m, kPoseReachMax_m);
    case PoseRefusal::scale:
        return fmt::format("SCALE must be {} to {}", kPoseScaleMin, kPoseScaleMax);
    default:
        return "the pose is invalid";
    }
}

/// Parses translation (3 numbers), rotation (4) and scale, which may be missing: `scale`.
Result<Pose, Refusal> parse_pose(std::span<const std::string_view> fields, double scale)
{
    std::array<double, 8> numbers{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, scale};
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
        const std::optional<double> number = parse_number(fields[i]);
        if (!number)
        {
            return Refusal{fmt::format("'{}' is not a finite number", printable(fields[i]))};
        }
        numbers.at(i) = *number;
    }
    Pose pose;
    std::copy_n(numbers.begin(), 3, pose.translation_m.begin());
    std::copy_n(numbers.begin() + 3, 4, pose.rotation.begin());
    pose.scale = numbers[7];
    const auto checked = checked_pose(pose);
    if (!checked)
    {
        return Refusal{refusal_text(checked.error())};
    }
    return checked.value();
}

Pose pose_between(const Pose& from, const Pose& to, double share)
{
    Pose pose = from;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        pose.translation_m[axis] += share * (to.translation_m[axis] - from.translation_m[axis]);
    }
    Eigen::Map<Eigen::Quaterniond>(pose.rotation.data()) =
        Eigen::Quaterniond(from.rotation.data())
            .slerp(share, Eigen::Quaterniond(to.rotation.data()))
            .normalized();
    pose.scale += share * (to.scale - from.scale);
    return pose;
}

/// First 8 names of the objects, for a message about an unknown name.
std::string names_of(std::span<const ScriptedObject> objects)
{
    constexpr std::size_t kNamed = 8;
    std::string names;
    for (const ScriptedObject& object : objects.first(std::min(kNamed, objects.size())))
    {
        names += (names.empty() ? "" : ", ") + object.name;
    }
    return objects.size() > kNamed ? fmt::format("{} and {} more", names, objects.size() - kNamed)
                                   : names;
}

/// Parses one line. `objects` have the scales at the time of the line.
Result<PoseLine, Refusal> parse_line(std::string_view text, std::span<ScriptedObject> objects)
{
    const std::vector<std::string_view> fields = fields_of(text);
    const bool goes = fields.size() == 3 && fields[2] == kGoneWord;
    const bool feels = fields.size() == 4 && fields[2] == kMaterialWord;
    if (!goes && !feels && (fields.size() < kFieldsMin || fields.size() > kFieldsMax))
    {
        return Refusal{fmt::format("is neither {} nor {}", kPoseLineForm, kMaterialLineForm)};
    }
    const std::optional<double> time_s = parse_number(fields[0]);
    if (!time_s || *time_s < 0.0 || *time_s > kPoseTimeMax_s)
    {
        return Refusal{
            fmt::format("time '{}' is not in 0 .. {} s", printable(fields[0]), kPoseTimeMax_s)};
    }
    const auto object = std::ranges::find(objects, fields[1], &ScriptedObject::name);
    if (object == objects.end())
    {
        return Refusal{fmt::format("no object is called '{}'; there are {}", printable(fields[1]),
                                   names_of(objects))};
    }
    PoseLine line{*time_s, static_cast<std::size_t>(object - objects.begin()), {}, {}};
    if (feels)
    {
        const auto material = parse_material_keys(fields[3]);
        if (!material)
        {
            return Refusal{"material " + material.error().text};
        }
        line.material = material.value();
    }
    else if (!goes)
    {
        auto pose = parse_pose(std::span(fields).subspan(2), object->scale);
        if (!pose)
        {
            return pose.error();
        }
        line.pose = pose.value();
        object->scale = line.pose->scale;
    }
    return line;
}

} // namespace

Result<std::vector<PoseLine>, Refusal> parse_pose_lines(std::string_view text,
                                                        std::span<const ScriptedObject> objects)
{
    std::vector<ScriptedObject> by_then(objects.begin(), objects.end());
    std::vector<PoseLine> lines;
    for (std::size_t number = 1; !text.empty(); ++number)
    {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t begin = line.find_first_not_of(kSpaces);
        if (begin == std::string_view::npos || line[begin] == '#')
        {
            continue;
        }
        auto parsed = parse_line(line, by_then);
        if (!parsed)
        {
            return Refusal{fmt::format("line {}: {}", number, parsed.error().text)};
        }
        if (!lines.empty() && parsed.value().time_s < lines.back().time_s)
        {
            return Refusal{
                fmt::format("line {}: time {} s is before {} s, the time of the previous line",
                            number, parsed.value().time_s, lines.back().time_s)};
        }
        lines.push_back(parsed.value());
    }
    if (lines.empty())
    {
        return Refusal{fmt::format("has no line {}", kPoseLineForm)};
    }
    return lines;
}

Result<std::vector<PoseLine>, Refusal> read_pose_file(const std::filesystem::path& path,
                                                      std::span<const ScriptedObject> objects)
{
    const auto refuse = [&](const std::string& reason)
    { return Refusal{fmt::format("{}: {}", path.string(), reason)}; };
    std::ifstream file(path, std::ios::binary);
    if (!file)
    {
        return refuse(fmt::format("cannot be opened: {}", std::strerror(errno)));
    }
    std::string text;
    std::array<char, 65'536> block{};
    do
    {
        file.read(block.data(), static_cast<std::streamsize>(block.size()));
        text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    } while (file && text.size() <= kPoseFileBytesMax);
    if (text.size() > kPoseFileBytesMax)
    {
        return refuse(fmt::format("is larger than {} bytes", kPoseFileBytesMax));
    }
    if (!file.eof())
    {
        return refuse("cannot be read");
    }
    auto lines = parse_pose_lines(text, objects);
    if (!lines)
    {
        return refuse(lines.error().text);
    }
    return lines;
}

Result<std::vector<PoseLine>, Refusal> interpolated(std::span<const PoseLine> lines,
                                                    std::size_t objects, double rate_hz)
{
    std::vector<PoseLine> all;
    std::vector<const PoseLine*> before(objects, nullptr);
    for (const PoseLine& line : lines)
    {
        // Lines with a material do not end a motion.
        const PoseLine* last = line.material ? nullptr : std::exchange(before[line.object], &line);
        const bool is_between = last != nullptr && last->pose && line.pose;
        const double steps = is_between ? std::floor((line.time_s - last->time_s) * rate_hz) : 0.0;
        if (static_cast<double>(all.size()) + steps >= static_cast<double>(kInterpolatedLinesMax))
        {
            return Refusal{fmt::format("--poses-rate: {} poses a second give more than {} poses",
                                       rate_hz, kInterpolatedLinesMax)};
        }
        for (double step = 1.0; step <= steps; ++step)
        {
            const double time_s = last->time_s + step / rate_hz;
            if (time_s < line.time_s) // None at the time of the line itself.
            {
                const double share = (time_s - last->time_s) / (line.time_s - last->time_s);
                all.push_back(
                    {time_s, line.object, pose_between(*last->pose, *line.pose, share), {}});
            }
        }
        all.push_back(line);
    }
    std::ranges::stable_sort(all, {}, &PoseLine::time_s);
    return all;
}

PosePlayer::PosePlayer(std::vector<PoseLine> lines, std::size_t objects, bool loops)
    : lines_(std::move(lines)), objects_(objects), loops_(loops)
{
    TACTUS_ASSERT(!lines_.empty());
    TACTUS_ASSERT(!loops || lines_.back().time_s > 0.0);
}

std::vector<PoseLine> PosePlayer::take_due(double now_s)
{
    const double round_s = lines_.back().time_s;
    // Newest material, then newest pose, of each object; null if none is due.
    std::vector<const PoseLine*> newest(2 * objects_, nullptr);
    if (loops_ && now_s - round_start_s_ > 2.0 * round_s)
    {
        // Skips whole rounds that were missed in a stall.
        round_start_s_ += (std::floor((now_s - round_start_s_) / round_s) - 1.0) * round_s;
    }
    for (auto due_s = next_s(); due_s && *due_s <= now_s; due_s = next_s())
    {
        const PoseLine& line = lines_[next_];
        newest[2 * line.object + (line.material ? 0 : 1)] = &line;
        ++next_;
        if (loops_ && next_ == lines_.size())
        {
            next_ = 0;
            round_start_s_ += round_s;
        }
    }
    std::vector<PoseLine> due;
    for (const PoseLine* line : newest)
    {
        if (line != nullptr)
        {
            due.push_back(*line);
        }
    }
    return due;
}

std::optional<double> PosePlayer::next_s() const
{
    return next_ < lines_.size() ? std::optional(round_start_s_ + lines_[next_].time_s)
                                 : std::nullopt;
}

} // namespace tactus
