// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Receives named values in order and writes them as columns, JSON or a JSON schema. A name ends in
/// the value's frame and unit, like the names of the code. One thread, not the haptic one: it
/// allocates.
///
/// Objects of one kind must add the same names in the same order, for all values.
class FieldSink
{
public:
    FieldSink() = default;
    FieldSink(const FieldSink&) = delete;
    FieldSink& operator=(const FieldSink&) = delete;
    virtual ~FieldSink() = default;

    /// Adds a number, which may be non-finite; none: unknown.
    virtual void number(const char* name, const std::optional<double>& value) = 0;
    virtual void integer(const char* name, const std::optional<std::int64_t>& value) = 0;
    virtual void flag(const char* name, bool value) = 0;
    virtual void text(const char* name, std::string_view value) = 0;
    /// Adds a set of names.
    virtual void words(const char* name, const std::vector<std::string>& value) = 0;
    virtual void vector(const char* name, const std::optional<Vec3>& value) = 0;
    /// Adds a rotation, as a unit quaternion: x, y, z, w.
    virtual void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) = 0;
};

/// Makes one line of comma-separated values (RFC 4180): the columns' names, their values, or empty
/// cells. A vector has columns NAME.x, .y, .z, a rotation .w, too. A flag is 1 or 0; words are
/// separated by blanks; an unknown value is an empty cell, a number that is not finite inf, -inf or
/// nan.
class CsvSink final : public FieldSink
{
public:
    enum class Cells : std::uint8_t
    {
        names,
        values,
        empty,
    };

    /// Selects the kind of the following cells. `prefix` goes before each name.
    void begin(Cells cells, std::string prefix = "");

    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    /// Returns the line, ended by CR LF, and empties the sink.
    [[nodiscard]] std::string take();

private:
    void cell(const char* name, const char* suffix, std::string_view value);

    Cells cells_{Cells::values};
    std::string prefix_;
    std::string line_;
    bool has_cells_{false};
};

/// Makes one JSON object on one line. An unknown value and a number that is not finite are null; a
/// set of words is an array, a vector one of three numbers, a rotation one of four. Characters
/// other than printable ASCII in names and texts become '?'.
class JsonSink final : public FieldSink
{
public:
    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    /// Opens an object: under this name, or as the next item of the open list. Values until close()
    /// belong to the object.
    void open(const char* name);
    void open_item();
    void close();
    void open_list(const char* name);
    void close_list();

    /// Returns the object, "{...}" without a line's end, and empties the sink.
    [[nodiscard]] std::string take();

private:
    void key(const char* name);

    std::string json_;
};

/// JSON Schema of the object that a JsonSink makes of the same calls.
class SchemaSink final : public FieldSink
{
public:
    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    [[nodiscard]] std::string take();

private:
    void add(const char* name, const char* type);

    std::string properties_;
};

// Functions that write the fields of a run, one for each kind of object. SI units; world frame
// unless a name says otherwise. Any thread, but not the haptic one: sinks allocate.

/// A frame of a recording and its output in the replay.
struct ReplayedFrameView
{
    std::uint64_t number{0};       ///< Number of the frame, from 0.
    std::int64_t first_time_ns{0}; ///< Value of RecordedFrame::now_ns of frame 0.
    const RecordedFrame& given;
    const FrameOutput& returned;
};

void tell_run(FieldSink& sink, const RecordedSetup& setup);
void tell_tool_spec(FieldSink& sink, const ToolSpec& tool);
/// `number`: index in RecordedSetup::objects.
void tell_object(FieldSink& sink, const RecordedSetup& setup, std::size_t number);
void tell_model_spec(FieldSink& sink, const RecordedSetup& setup, std::size_t number);

/// Writes time, work, faults and scene.
void tell_frame(FieldSink& sink, const ReplayedFrameView& frame);
void tell_tool(FieldSink& sink, const ReplayedFrameView& frame, std::size_t tool);
void tell_pair(FieldSink& sink, const PairOutput& pair);
void tell_model(FieldSink& sink, const ModelOutput& model);
void tell_change(FieldSink& sink, const SceneChange& change);

} // namespace tactus
