// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/film.hpp"

#include "platform/recording/replay.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/content_hash.hpp"
#include "transport/telemetry_from_frame.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <variant>

namespace tactus::view
{

namespace
{

/// A model whose base mesh and received pieces are in recordings.
class RecordedPieces final : public KnownModel
{
public:
    /// A recording, and the number of the model in it.
    using Source = std::pair<std::shared_ptr<const Recording>, std::uint32_t>;

    RecordedPieces(Source source, std::string name)
        : sources_{std::move(source)}
        , name_(std::move(name))
        , header_(ModelHeader::parse(model_of(sources_[0]).header).value())
        , hash_(model_hash(model_of(sources_[0]).header))
    {
    }
    /// Adds another recording of the same model. Call it before any read().
    void add(Source source) { sources_.push_back(std::move(source)); }

    [[nodiscard]] const std::string& name() const noexcept override { return name_; }
    [[nodiscard]] const ContentHash& hash() const noexcept override { return hash_; }
    [[nodiscard]] const ModelHeader& header() const noexcept override { return header_; }
    [[nodiscard]] std::optional<Refusal> bring(std::span<const ContentKey> /*keys*/) override
    {
        return std::nullopt;
    }
    [[nodiscard]] Result<Done, Refusal> read(ContentKey key, std::vector<std::byte>& coded) override
    {
        for (const Source& source : sources_)
        {
            const std::vector<std::byte>& base = model_of(source).base;
            const std::span<const std::byte> piece = key.kind == ContentKind::base && !base.empty()
                                                         ? std::span<const std::byte>(base)
                                                         : source.first->piece(source.second, key);
            if (!piece.empty())
            {
                coded.assign(piece.begin(), piece.end());
                return Done{};
            }
        }
        return Refusal{
            fmt::format("the recording has only a part of model {}: piece {} of kind {} is missing",
                        name_, key.number, static_cast<int>(key.kind))};
    }

private:
    [[nodiscard]] static const RecordedModel& model_of(const Source& source)
    {
        return source.first->setup().models[source.second];
    }

    std::vector<Source> sources_;
    std::string name_;
    ModelHeader header_;
    ContentHash hash_;
};

/// Adds a model to the shelf, or its source to the model that is there.
void put_on(ModelShelf& shelf, const std::shared_ptr<RecordedPieces>& model,
            RecordedPieces::Source source)
{
    const auto known = std::dynamic_pointer_cast<RecordedPieces>(shelf.find(model->hash()));
    if (known != nullptr)
    {
        known->add(std::move(source));
    }
    shelf.add(model);
}

/// Shape in the form of hrtc's --tool option, for shapes that the page can draw.
std::string shape_of(const ToolSpec& tool)
{
    if (const auto* segment = std::get_if<Segment>(&tool.core))
    {
        return fmt::format("capsule:{:g},{:g}", tool.radius_m,
                           (segment->to - segment->from).norm());
    }
    if (const auto* box = std::get_if<Box>(&tool.core))
    {
        return fmt::format("box:{:g},{:g},{:g},{:g}", 2 * box->half.x(), 2 * box->half.y(),
                           2 * box->half.z(), tool.radius_m);
    }
    return std::holds_alternative<PointCore>(tool.core) ? fmt::format("sphere:{:g}", tool.radius_m)
           : std::holds_alternative<Hull>(tool.core)    ? "hull"
                                                        : "mesh";
}

/// Name of a file, with only characters that no text format must escape.
std::string name_of(const std::string& path)
{
    std::string name = std::filesystem::path(path).filename().string();
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
    };
    std::ranges::replace_if(
        name, [&](char c) { return !is_plain(c); }, '_');
    return name;
}

/// FNV-1a hash of the bits of the added values.
class Fold
{
public:
    template <typename T>
    void add(const T& value)
    {
        static_assert(std::is_arithmetic_v<T>);
        std::array<unsigned char, sizeof(T)> bytes{};
        std::memcpy(bytes.data(), &value, sizeof(T));
        for (const unsigned char byte : bytes)
        {
            hash_ = (hash_ ^ byte) * 0x0000'0100'0000'01B3U;
        }
    }
    [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

private:
    std::uint64_t hash_{0xCBF2'9CE4'8422'2325U};
};

std::uint64_t hash_of(const std::vector<SceneChange>& changes)
{
    Fold fold;
    for (const SceneChange& change : changes)
    {
        fold.add(static_cast<std::uint8_t>(change.kind));
        fold.add(change.number);
        fold.add(change.generation);
        for (int i = 0; has_pose(change.kind) && i < 3; ++i)
        {
            fold.add(change.pose.translation_m[i]);
            for (int j = 0; j < 3; ++j)
            {
                fold.add(change.pose.rotation(i, j));
            }
        }
    }
    return fold.value();
}

std::uint64_t hash_of(const std::vector<QueueEvent>& events)
{
    Fold fold;
    for (const QueueEvent& event : events)
    {
        fold.add(static_cast<std::uint8_t>(event.kind));
        fold.add(event.owner);
        fold.add(static_cast<std::uint8_t>(event.key.kind));
        fold.add(event.key.number);
        fold.add(event.linked);
    }
    return fold.value();
}

} // namespace

/// Adds the data of each frame to a film while the recording is replayed.
struct Film::Maker
{
    Film& film;
    const RecordedSetup& setup;
    Frame* frame{nullptr};         ///< Frame of the replay; null before its start.
    std::vector<PageMeta> slots{}; ///< Page slots as of the previous frame.

    void take(std::uint64_t number, const RecordedFrame& given, const FrameOutput& returned)
    {
        Moment moment;
        if (number > 0)
        {
            moment = film.moments_.back();
        }
        moment.time_ns = given.now_ns;
        moment.scene = hash_of(given.changes);
        moment.pieces = hash_of(given.events);
        moment.faults = static_cast<std::uint32_t>(returned.faults);
        moment.faults_seen |= moment.faults;
        moment.kind = worst_of(returned.pairs);
        ++moment.answers[static_cast<std::size_t>(moment.kind)];
        Fold faces;
        for (std::size_t i = 0; i < returned.models.size(); ++i)
        {
            faces.add(returned.models[i].state_hash);
            film.model_states_[i].set(number, telemetry_of(returned.models[i]));
        }
        moment.faces = faces.value();
        for (std::size_t i = 0; i < film.tool_count_; ++i)
        {
            film.tools_.push_back(
                telemetry_of(given.tools[i], given.devices[i], returned.tools[i]));
        }
        for (const PairOutput& pair : returned.pairs)
        {
            film.pairs_.push_back(telemetry_of(pair));
        }
        moment.pairs_end = static_cast<std::uint32_t>(film.pairs_.size());
        std::ranges::transform(frame->regions(), std::back_inserter(film.regions_),
                               shown_region_of);
        moment.regions_end = static_cast<std::uint32_t>(film.regions_.size());
        film.budgets_.set(number, given.budgets);
        take_pages(number);
        take_objects(number, given);
        film.moments_.push_back(moment);
    }

private:
    /// Worst kind of answer of a frame. From best to worst: separated, exact, within tolerance,
    /// bounded, stale.
    static AnswerKind worst_of(std::span<const PairOutput> pairs)
    {
        constexpr std::array order{AnswerKind::stale, AnswerKind::bounded,
                                   AnswerKind::within_tolerance, AnswerKind::exact};
        for (const AnswerKind kind : order)
        {
            if (std::ranges::find(pairs, kind, &PairOutput::kind) != pairs.end())
            {
                return kind;
            }
        }
        return AnswerKind::separated;
    }

    /// Records changed pages, removals first: the chunk of a removed page may now be in another
    /// slot.
    void take_pages(std::uint64_t number)
    {
        const std::span<const PageMeta> metas = frame->pools().cache.pages.metas;
        slots.resize(metas.size());
        for (const bool goes : {true, false})
        {
            for (std::size_t i = 0; i < metas.size(); ++i)
            {
                const bool is_other =
                    slots[i].chunk != metas[i].chunk || slots[i].owner != metas[i].owner;
                const PageMeta& meta = goes ? slots[i] : metas[i];
                const bool counts = goes ? is_other : is_other || slots[i].refined != meta.refined;
                if (counts && !meta.chunk.is_none())
                {
                    film.pages_[{meta.owner, meta.chunk.value}].set(
                        number, goes ? Page{} : Page{meta.refined});
                }
            }
        }
        std::ranges::copy(metas, slots.begin());
    }

    void take_objects(std::uint64_t number, const RecordedFrame& given)
    {
        const ObjectTable& objects = frame->objects();
        for (std::uint32_t i = 0; number == 0 && i < objects.capacity(); ++i)
        {
            take_object(number, i);
        }
        for (const SceneChange& change : given.changes)
        {
            if (change.number < objects.capacity() && change.kind != SceneChangeKind::tool_comes &&
                change.kind != SceneChangeKind::tool_goes)
            {
                take_object(number, change.number);
            }
        }
    }

    void take_object(std::uint64_t number, std::uint32_t which)
    {
        const Object& object = frame->objects()[which];
        std::optional<ObjectTelemetry> seen;
        if (object.is_resident)
        {
            const std::uint32_t model = object.spec.model.value;
            seen = ObjectTelemetry{
                0,
                which,
                which,
                setup.name_of({RecordedName::Kind::object, which, object.generation}),
                film.models_[model].hash,
                source_pose_of(object.pose, film.origins_m_[model])};
        }
        if (seen || film.objects_.contains(which))
        {
            film.objects_[which].set(number, seen);
        }
    }
};

Result<std::unique_ptr<Film>, Refusal> Film::develop(const std::string& path, std::uint8_t number,
                                                     ModelShelf& shelf,
                                                     const std::function<bool()>& goes_on)
{
    auto read = Recording::read(path);
    if (!read)
    {
        return read.error();
    }
    const auto recording = std::make_shared<const Recording>(std::move(read).value());
    std::unique_ptr<Film> film(new Film);
    const RecordedSetup& setup = recording->setup();
    film->id_.back() = number;
    film->name_ = name_of(path);
    film->period_ns_ = setup.period_ns;
    film->tool_count_ = setup.tools.size();
    for (const ToolSpec& tool : setup.tools)
    {
        film->shapes_.push_back({SafetyState::idle, ForceOff::none, shape_of(tool), tool.radius_m});
    }
    for (std::uint32_t i = 0; i < setup.models.size(); ++i)
    {
        const std::string told = setup.name_of({RecordedName::Kind::model, i});
        const std::string name = told.empty() ? fmt::format("model-{}", i) : told;
        const RecordedPieces::Source source{recording, i};
        const auto model = std::make_shared<RecordedPieces>(source, name);
        film->models_.push_back({name, model->hash(), model->header().fields().revision});
        film->origins_m_.push_back(model->header().origin_m());
        put_on(shelf, model, source);
    }
    film->model_states_.resize(setup.models.size());
    Maker maker{*film, setup};
    ReplayWatch watch;
    watch.made = [&](Frame& frame) { maker.frame = &frame; };
    watch.ends = [&](std::uint64_t frame, const RecordedFrame& given, const FrameOutput& returned)
    { maker.take(frame, given, returned); };
    watch.goes_on = goes_on;
    watch.runs_failed = false;
    const auto report = replay(*recording, nullptr, watch);
    if (!report || film->moments_.empty())
    {
        return Refusal{path + ": " + (report ? "the recording has no frame" : report.error().text)};
    }
    film->note_ =
        report.value().difference || recording->has_failed() || !recording->missing().empty()
            ? replay_line(*recording, report.value())
            : "";
    return film;
}

std::span<const ToolTelemetry> Film::tools(std::uint64_t frame) const
{
    return std::span(tools_).subspan(frame * tool_count_, tool_count_);
}

std::span<const PairTelemetry> Film::pairs(std::uint64_t frame) const
{
    const std::uint32_t begin = frame == 0 ? 0 : moments_[frame - 1].pairs_end;
    return std::span(pairs_).subspan(begin, moments_[frame].pairs_end - begin);
}

std::span<const RefinementStateRegion> Film::regions(std::uint64_t frame) const
{
    const std::uint32_t begin = frame == 0 ? 0 : moments_[frame - 1].regions_end;
    return std::span(regions_).subspan(begin, moments_[frame].regions_end - begin);
}

LiveController Film::at(std::uint64_t frame) const
{
    frame = std::min<std::uint64_t>(frame, frames() - 1);
    const Moment& moment = moments_[frame];
    LiveController controller;
    controller.is_recorded = true;
    controller.told.id = id_;
    controller.told.name = name_;
    controller.told.serial = frame;
    Telemetry& telemetry = controller.told.telemetry;
    telemetry.frame = frame + 1;
    telemetry.period_ns = period_ns_;
    telemetry.time_ns = moment.time_ns;
    telemetry.exact = moment.answers[static_cast<std::size_t>(AnswerKind::exact)];
    telemetry.separated = moment.answers[static_cast<std::size_t>(AnswerKind::separated)];
    telemetry.bounded = moment.answers[static_cast<std::size_t>(AnswerKind::bounded)];
    telemetry.stale = moment.answers[static_cast<std::size_t>(AnswerKind::stale)];
    telemetry.within_tolerance =
        moment.answers[static_cast<std::size_t>(AnswerKind::within_tolerance)];
    telemetry.faults_now = moment.faults;
    telemetry.faults_seen = moment.faults_seen;
    telemetry.tool_count = static_cast<std::uint32_t>(tool_count_);
    std::ranges::copy(tools(frame), telemetry.tools.begin());
    telemetry.pair_count = static_cast<std::uint32_t>(pairs(frame).size());
    std::ranges::copy(pairs(frame), telemetry.pairs.begin());
    add_models(frame, controller);
    controller.told.state = state(frame);
    for (const auto& [number, steps] : objects_)
    {
        if (const auto* seen = steps.at(frame); seen != nullptr && *seen)
        {
            controller.objects.push_back(**seen);
        }
    }
    return controller;
}

void Film::add_models(std::uint64_t frame, LiveController& controller) const
{
    Telemetry& telemetry = controller.told.telemetry;
    telemetry.model_count =
        static_cast<std::uint32_t>(std::min<std::size_t>(models_.size(), kMaxShownModels));
    for (std::uint32_t i = 0; i < telemetry.model_count; ++i)
    {
        controller.told.models.push_back(models_[i]);
        telemetry.models[i] = *model_states_[i].at(frame);
    }
}

StatePointer Film::state(std::uint64_t frame) const
{
    if (frame >= frames())
    {
        return nullptr;
    }
    auto seen = std::make_shared<dds::SeenState>();
    seen->serial = frame;
    RefinementState& state = seen->state;
    state.frame = frame + 1;
    state.budgets = *budgets_.at(frame);
    state.tools = shapes_;
    state.regions.assign(regions(frame).begin(), regions(frame).end());
    for (const ModelIdentity& model : models_)
    {
        state.models.push_back({model.hash, {}, {}});
    }
    for (const auto& [name, steps] : pages_)
    {
        if (const Page* page = steps.at(frame); page != nullptr && *page)
        {
            state.models[name.first].pages.push_back({{name.second}, **page});
        }
    }
    return seen;
}

namespace
{

/// Distance of two positions.
double apart(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

} // namespace

Film::Gap Film::compare(const Film& a, const Film& b, std::uint64_t frame, What what)
{
    Gap gap;
    const auto look = [&gap](bool differs, double amount)
    {
        gap.differs = gap.differs || differs;
        gap.amount = differs ? std::max(gap.amount, amount) : gap.amount;
    };
    const Moment& one = a.moments_[frame];
    const Moment& other = b.moments_[frame];
    const auto tools = std::pair(a.tools(frame), b.tools(frame));
    const auto pairs = std::pair(a.pairs(frame), b.pairs(frame));
    const std::size_t tool_count = std::min(tools.first.size(), tools.second.size());
    switch (what)
    {
    case What::hand:
        look(tools.first.size() != tools.second.size(), 0.0);
        for (std::size_t i = 0; i < tool_count; ++i)
        {
            const ToolTelemetry& left = tools.first[i];
            const ToolTelemetry& right = tools.second[i];
            look(left.position_m != right.position_m || left.rotation != right.rotation,
                 apart(left.position_m, right.position_m));
        }
        break;
    case What::scene:
        look(one.scene != other.scene, 0.0);
        break;
    case What::pieces:
        look(one.pieces != other.pieces, 0.0);
        break;
    case What::faces:
        look(one.faces != other.faces, 0.0);
        break;
    case What::answers:
        look(pairs.first.size() != pairs.second.size(), 0.0);
        for (std::size_t i = 0; i < std::min(pairs.first.size(), pairs.second.size()); ++i)
        {
            const PairTelemetry& left = pairs.first[i];
            const PairTelemetry& right = pairs.second[i];
            look(left.object != right.object || left.kind != right.kind ||
                     left.lower_m != right.lower_m || left.upper_m != right.upper_m,
                 std::abs(left.lower_m - right.lower_m));
        }
        break;
    case What::forces:
        for (std::size_t i = 0; i < tool_count; ++i)
        {
            look(tools.first[i].force_n != tools.second[i].force_n ||
                     tools.first[i].torque_nm != tools.second[i].torque_nm,
                 apart(tools.first[i].force_n, tools.second[i].force_n));
        }
        break;
    }
    return gap;
}

namespace
{

struct Kind
{
    const char* what;
    const char* unit; ///< Unit; null: the difference has no amount.
    double per_unit;
};

constexpr std::array<Kind, Film::kWhats> kKinds{{{"the device poses", "mm", 1e3},
                                                 {"the scene", nullptr, 0.0},
                                                 {"the data from servers", nullptr, 0.0},
                                                 {"the faces", nullptr, 0.0},
                                                 {"the distances", "mm", 1e3},
                                                 {"the forces", "N", 1.0}}};

std::optional<FilmDifference> first_difference(const Film& a, const Film& b, std::size_t which)
{
    const Kind& kind = kKinds[which];
    const std::uint64_t frames = std::min(a.frames(), b.frames());
    std::optional<FilmDifference> found;
    double first = 0.0;
    double most = 0.0;
    std::uint64_t most_frame = 0;
    std::uint64_t count = 0;
    for (std::uint64_t frame = 0; frame < frames; ++frame)
    {
        const Film::Gap gap = Film::compare(a, b, frame, static_cast<Film::What>(which));
        if (!gap.differs)
        {
            continue;
        }
        ++count;
        if (!found)
        {
            found = FilmDifference{kind.what, "", frame};
            first = gap.amount;
        }
        if (gap.amount > most)
        {
            most = gap.amount;
            most_frame = frame;
        }
    }
    if (found)
    {
        found->how = fmt::format("in {} of {} frames", count, frames);
        if (kind.unit != nullptr)
        {
            found->how += fmt::format(", by {:.3g} {} at first, at most {:.3g} {} in frame {}",
                                      first * kind.per_unit, kind.unit, most * kind.per_unit,
                                      kind.unit, most_frame);
        }
    }
    return found;
}

} // namespace

Films::Films(std::vector<std::unique_ptr<Film>> films) : films_(std::move(films))
{
    if (films_.size() != 2)
    {
        return;
    }
    const Film& a = *films_[0];
    const Film& b = *films_[1];
    for (std::size_t which = 0; which < Film::kWhats; ++which)
    {
        if (auto difference = first_difference(a, b, which))
        {
            differences_.push_back(*std::move(difference));
        }
    }
    if (a.frames() != b.frames())
    {
        differences_.push_back({"the length",
                                fmt::format("{} frames and {}", a.frames(), b.frames()),
                                std::min(a.frames(), b.frames()) - 1});
    }
}

std::uint64_t Films::frames() const noexcept
{
    std::uint64_t most = 0;
    for (const auto& film : films_)
    {
        most = std::max(most, film->frames());
    }
    return most;
}

Snapshot Films::at(std::uint64_t frame) const
{
    Snapshot snapshot;
    snapshot.serial = frame;
    for (const auto& film : films_)
    {
        snapshot.controllers.push_back(film->at(frame));
    }
    return snapshot;
}

StatePointer Films::state(const std::string& controller, std::uint64_t frame) const
{
    const auto found = std::ranges::find_if(films_, [&](const auto& film)
                                            { return id_text(film->id()) == controller; });
    return found == films_.end() ? nullptr : (*found)->state(frame);
}

} // namespace tactus::view
