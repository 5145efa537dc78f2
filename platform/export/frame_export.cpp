// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/frame_export.hpp"

#include "platform/export/field_sink.hpp"
#include "platform/export/mcap_writer.hpp"
#include "rt_core/base/assert.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

/// Largest number of pair channels, more than a reader displays; pairs beyond it share a channel.
constexpr std::size_t kMaxPairChannels = 4'096;

/// Size from which on buffered text is written to the file.
constexpr std::size_t kBufferBytes = std::size_t{1} << 16U;

/// Writes the set-up of a recording.
void tell_setup(JsonSink& sink, const RecordedSetup& setup)
{
    tell_run(sink, setup);
    const auto list = [&sink](const char* name, std::size_t count, const auto& tell_item)
    {
        sink.open_list(name);
        for (std::size_t i = 0; i < count; ++i)
        {
            sink.open_item();
            tell_item(i);
            sink.close();
        }
        sink.close_list();
    };
    list("tools", setup.tools.size(), [&](std::size_t i) { tell_tool_spec(sink, setup.tools[i]); });
    list("objects", setup.objects.size(), [&](std::size_t i) { tell_object(sink, setup, i); });
    list("models", setup.models.size(), [&](std::size_t i) { tell_model_spec(sink, setup, i); });
}

/// A file and its buffered text.
class ExportFile
{
public:
    explicit ExportFile(AtomicFile file) : file_(std::move(file)) {}

    void write(std::span<const std::byte> bytes)
    {
        if (stored_)
        {
            stored_ = file_.write(bytes);
        }
    }
    void write(std::string_view text)
    {
        text_ += text;
        if (text_.size() >= kBufferBytes)
        {
            flush();
        }
    }
    [[nodiscard]] Result<Done, Refusal> commit()
    {
        flush();
        return stored_ ? file_.commit() : stored_;
    }

private:
    void flush()
    {
        write(std::as_bytes(std::span(text_)));
        text_.clear();
    }

    AtomicFile file_;
    std::string text_;
    Result<Done, Refusal> stored_{Done{}};
};

/// CSV with one line a frame: each tool and its nearest object, then each model.
class CsvExport final : public FrameExport
{
public:
    CsvExport(AtomicFile file, const RecordedSetup& setup) : file_(std::move(file)), setup_(setup)
    {
    }

    void add(const ReplayedFrameView& frame) override
    {
        if (!has_names_)
        {
            has_names_ = true;
            tell(CsvSink::Cells::names, frame);
        }
        tell(CsvSink::Cells::values, frame);
    }
    [[nodiscard]] Result<Done, Refusal> commit() override { return file_.commit(); }

private:
    void tell(CsvSink::Cells cells, const ReplayedFrameView& frame)
    {
        sink_.begin(cells);
        tell_frame(sink_, frame);
        for (std::size_t i = 0; i < setup_.tools.size(); ++i)
        {
            sink_.begin(cells, fmt::format("tool{}.", i));
            tell_tool(sink_, frame, i);
            tell_nearest(cells, frame, i);
        }
        for (std::size_t i = 0; i < setup_.models.size(); ++i)
        {
            sink_.begin(cells, fmt::format("model{}.", i));
            tell_model(sink_, frame.returned.models[i]);
        }
        file_.write(sink_.take());
    }

    void tell_nearest(CsvSink::Cells cells, const ReplayedFrameView& frame, std::size_t tool)
    {
        const PairOutput* nearest = nullptr;
        for (const PairOutput& pair : frame.returned.pairs)
        {
            if (pair.tool == tool && (nearest == nullptr || pair.lower_m < nearest->lower_m))
            {
                nearest = &pair;
            }
        }
        const bool is_missing = nearest == nullptr && cells == CsvSink::Cells::values;
        sink_.begin(is_missing ? CsvSink::Cells::empty : cells,
                    fmt::format("tool{}.nearest.", tool));
        tell_pair(sink_, nearest == nullptr ? PairOutput{} : *nearest);
    }

    ExportFile file_;
    const RecordedSetup& setup_;
    CsvSink sink_;
    bool has_names_{false};
};

/// One line of JSON a frame; the first has the set-up, too.
class JsonLinesExport final : public FrameExport
{
public:
    JsonLinesExport(AtomicFile file, const RecordedSetup& setup)
        : file_(std::move(file)), setup_(setup)
    {
    }

    void add(const ReplayedFrameView& frame) override
    {
        tell_frame(sink_, frame);
        tell_list("tools", frame.returned.tools.size(),
                  [&](std::size_t i) { tell_tool(sink_, frame, i); });
        tell_list("pairs", frame.returned.pairs.size(),
                  [&](std::size_t i) { tell_pair(sink_, frame.returned.pairs[i]); });
        tell_list("models", frame.returned.models.size(),
                  [&](std::size_t i) { tell_model(sink_, frame.returned.models[i]); });
        tell_list("changes", frame.given.changes.size(),
                  [&](std::size_t i) { tell_change(sink_, frame.given.changes[i]); });
        if (frame.number == 0)
        {
            sink_.open("setup");
            tell_setup(sink_, setup_);
            sink_.close();
        }
        file_.write(sink_.take() + "\n");
    }
    [[nodiscard]] Result<Done, Refusal> commit() override { return file_.commit(); }

private:
    template <typename Tell>
    void tell_list(const char* name, std::size_t count, const Tell& tell)
    {
        sink_.open_list(name);
        for (std::size_t i = 0; i < count; ++i)
        {
            sink_.open_item();
            tell(i);
            sink_.close();
        }
        sink_.close_list();
    }

    ExportFile file_;
    const RecordedSetup& setup_;
    JsonSink sink_;
};

/// MCAP with one channel for each tool, model and pair, so that PlotJuggler and Foxglove make one
/// series of each.
class McapExport final : public FrameExport
{
public:
    McapExport(AtomicFile file, const RecordedSetup& setup)
        : file_(std::move(file)), setup_(setup), writer_("tactus")
    {
        const std::uint16_t of_setup = writer_.add_schema("tactus.Setup", R"({"type":"object"})");
        setup_channel_ = writer_.add_channel("/setup", of_setup);
        pair_schema_ =
            add_schema("tactus.Pair", [](SchemaSink& sink) { tell_pair(sink, PairOutput{}); });
        change_channel_ =
            writer_.add_channel("/changes", add_schema("tactus.Change", [](SchemaSink& sink)
                                                       { tell_change(sink, SceneChange{}); }));
    }

    void add(const ReplayedFrameView& frame) override
    {
        frame_ = &frame;
        if (frame.number == 0)
        {
            begin(frame);
            tell_setup(sink_, setup_);
            send(setup_channel_);
        }
        tell_frame(sink_, frame);
        send(frame_channel_);
        for (std::size_t i = 0; i < tool_channels_.size(); ++i)
        {
            tell_tool(sink_, frame, i);
            send(tool_channels_[i]);
        }
        for (std::size_t i = 0; i < model_channels_.size(); ++i)
        {
            tell_model(sink_, frame.returned.models[i]);
            send(model_channels_[i]);
        }
        for (const PairOutput& pair : frame.returned.pairs)
        {
            tell_pair(sink_, pair);
            send(channel_of(pair));
        }
        for (const SceneChange& change : frame.given.changes)
        {
            tell_change(sink_, change);
            send(change_channel_);
        }
        file_.write(writer_.take_bytes());
    }

    [[nodiscard]] Result<Done, Refusal> commit() override
    {
        writer_.finish();
        file_.write(writer_.take_bytes());
        return file_.commit();
    }

private:
    template <typename Tell>
    [[nodiscard]] std::uint16_t add_schema(std::string_view name, const Tell& tell)
    {
        SchemaSink sink;
        tell(sink);
        return writer_.add_schema(name, sink.take());
    }

    /// Adds the channels of every frame; `frame` provides the names.
    void begin(const ReplayedFrameView& frame)
    {
        frame_channel_ =
            writer_.add_channel("/frame", add_schema("tactus.Frame", [&](SchemaSink& sink)
                                                     { tell_frame(sink, frame); }));
        const auto tool =
            add_schema("tactus.Tool", [&](SchemaSink& sink) { tell_tool(sink, frame, 0); });
        for (std::size_t i = 0; i < setup_.tools.size(); ++i)
        {
            tool_channels_.push_back(writer_.add_channel(fmt::format("/tool/{}", i), tool));
        }
        const auto model =
            add_schema("tactus.Model", [](SchemaSink& sink) { tell_model(sink, ModelOutput{}); });
        for (std::size_t i = 0; i < setup_.models.size(); ++i)
        {
            model_channels_.push_back(writer_.add_channel(fmt::format("/model/{}", i), model));
        }
    }

    [[nodiscard]] std::uint16_t channel_of(const PairOutput& pair)
    {
        const std::pair key(pair.tool, pair.object);
        if (const auto at = pair_channels_.find(key); at != pair_channels_.end())
        {
            return at->second;
        }
        if (pair_channels_.size() == kMaxPairChannels)
        {
            if (!other_pairs_channel_)
            {
                other_pairs_channel_ = writer_.add_channel("/pairs", pair_schema_);
            }
            return *other_pairs_channel_;
        }
        return pair_channels_[key] = writer_.add_channel(
                   fmt::format("/tool/{}/object/{}", pair.tool, pair.object), pair_schema_);
    }

    void send(std::uint16_t channel)
    {
        const auto time_ns = std::max(frame_->given.now_ns, std::int64_t{0});
        writer_.add_message(channel, static_cast<std::uint32_t>(frame_->number),
                            static_cast<std::uint64_t>(time_ns), sink_.take());
    }

    ExportFile file_;
    const RecordedSetup& setup_;
    McapWriter writer_;
    JsonSink sink_;
    const ReplayedFrameView* frame_{nullptr}; ///< Frame being written.
    std::uint16_t pair_schema_{0};
    std::uint16_t setup_channel_{0};
    std::uint16_t change_channel_{0};
    std::uint16_t frame_channel_{0};
    std::vector<std::uint16_t> tool_channels_;
    std::vector<std::uint16_t> model_channels_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint16_t> pair_channels_;
    std::optional<std::uint16_t> other_pairs_channel_;
};

} // namespace

bool is_export_name(std::string_view path) noexcept
{
    return path.ends_with(".csv") || path.ends_with(".jsonl") || path.ends_with(".mcap");
}

Result<std::unique_ptr<FrameExport>, Refusal> FrameExport::create(const std::string& path,
                                                                  const RecordedSetup& setup)
{
    TACTUS_ASSERT(is_export_name(path));
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    if (path.ends_with(".csv"))
    {
        return std::unique_ptr<FrameExport>(
            std::make_unique<CsvExport>(std::move(file).value(), setup));
    }
    if (path.ends_with(".jsonl"))
    {
        return std::unique_ptr<FrameExport>(
            std::make_unique<JsonLinesExport>(std::move(file).value(), setup));
    }
    return std::unique_ptr<FrameExport>(
        std::make_unique<McapExport>(std::move(file).value(), setup));
}

} // namespace tactus
