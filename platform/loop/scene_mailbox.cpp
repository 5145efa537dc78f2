// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/scene_mailbox.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

namespace
{

constexpr std::size_t kWordBits = 64;

constexpr std::size_t words_of(std::size_t objects) noexcept
{
    return (objects + kWordBits - 1) / kWordBits;
}

constexpr std::uint64_t bit_of(std::size_t object) noexcept
{
    return std::uint64_t{1} << object % kWordBits;
}

/// Number of the object of the lowest set bit in `bits`, the word of that index.
constexpr std::size_t first_of(std::size_t word, std::uint64_t bits) noexcept
{
    return word * kWordBits + static_cast<std::size_t>(std::countr_zero(bits));
}

/// Time between two stamps of a server's clock; 0 unless it is positive and at most a day, since a
/// server's stamps are not trusted.
std::int64_t since_ns(std::int64_t before_ns, std::int64_t now_ns) noexcept
{
    constexpr std::int64_t kDay_ns = 86'400'000'000'000;
    const bool is_time =
        now_ns > before_ns && (before_ns >= 0) == (now_ns >= 0) && now_ns - before_ns <= kDay_ns;
    return is_time ? now_ns - before_ns : 0;
}

} // namespace

SceneMailbox::SceneMailbox(std::span<const ObjectPose> placed, std::size_t objects,
                           Duration age_limit, double speed_max_m_per_s)
    : age_limit_(age_limit)
    , speed_limit_{speed_max_m_per_s}
    , places_(placed.begin(), placed.end())
    , samples_(objects)
    , blends_(objects)
    , uses_(objects)
    , unread_(words_of(objects))
    , awake_(words_of(objects))
    , numbers_(objects)
    , generations_(objects)
    , scene_event_slots_(kWaiting)
    , scene_events_(scene_event_slots_)
    // NOLINTBEGIN(*-avoid-c-arrays)
    , mailboxes_(std::make_unique<Mailbox<PoseSample>[]>(objects))
    , heard_ns_(std::make_unique<std::atomic<std::int64_t>[]>(objects))
    , came_(std::make_unique<std::atomic<std::uint64_t>[]>(words_of(objects)))
// NOLINTEND(*-avoid-c-arrays)
{
    TACTUS_ASSERT(placed.size() <= objects);
    places_.resize(objects);
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
        blends_[i].is_resident = true;
    }
}

bool SceneMailbox::try_add(std::size_t object, std::uint32_t generation, const ObjectSpec& spec,
                           const ObjectPose& pose, MonotonicTime arrival) noexcept
{
    TACTUS_ASSERT(object < samples_.size());
    TACTUS_ASSERT(generation > generations_[object] || numbers_[object] == 0);
    if (scene_events_.size() == kWaiting)
    {
        return false;
    }
    generations_[object] = generation;
    SceneEvent scene_event;
    scene_event.kind = SceneChangeKind::object_comes;
    scene_event.object = static_cast<std::uint32_t>(object);
    scene_event.sample = sample_of(object, pose, arrival);
    scene_event.model = spec.model.value;
    scene_event.material = spec.material;
    note_heard(object, arrival);
    return scene_events_.try_push(scene_event);
}

bool SceneMailbox::try_remove(std::size_t object) noexcept
{
    TACTUS_ASSERT(object < samples_.size());
    SceneEvent scene_event;
    scene_event.object = static_cast<std::uint32_t>(object);
    scene_event.sample.generation = generations_[object];
    return scene_events_.try_push(scene_event);
}

bool SceneMailbox::try_set_material(std::size_t object, const Material& material) noexcept
{
    TACTUS_ASSERT(object < samples_.size());
    SceneEvent scene_event;
    scene_event.kind = SceneChangeKind::object_feels;
    scene_event.object = static_cast<std::uint32_t>(object);
    scene_event.sample.generation = generations_[object];
    scene_event.material = material;
    return scene_events_.try_push(scene_event);
}

void SceneMailbox::put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept
{
    TACTUS_ASSERT(object < samples_.size());
    mailboxes_[object].write(sample_of(object, pose, arrival));
    note_heard(object, arrival);
    // Pairs with the acquire in take_samples().
    came_[object / kWordBits].fetch_or(bit_of(object), std::memory_order_release);
}

SceneMailbox::PoseSample SceneMailbox::sample_of(std::size_t object, const ObjectPose& pose,
                                                 MonotonicTime arrival) noexcept
{
    PoseSample sample;
    for (int i = 0; i < 9; ++i)
    {
        sample.rotation[static_cast<std::size_t>(i)] = pose.rotation(i / 3, i % 3);
    }
    const Vec3& at_m = pose.translation_m;
    sample.translation_m = {at_m.x(), at_m.y(), at_m.z()};
    sample.scale = pose.scale;
    sample.stamp_ns = pose.stamp_ns;
    sample.revision = pose.revision;
    sample.arrival_ns = arrival.ns;
    sample.generation = generations_[object];
    sample.number = ++numbers_[object];
    return sample;
}

ObjectPose SceneMailbox::pose_of(const PoseSample& sample) noexcept
{
    ObjectPose pose;
    for (int i = 0; i < 9; ++i)
    {
        pose.rotation(i / 3, i % 3) = sample.rotation[static_cast<std::size_t>(i)];
    }
    const auto& at_m = sample.translation_m;
    pose.translation_m = Vec3(at_m[0], at_m[1], at_m[2]);
    pose.scale = sample.scale;
    pose.stamp_ns = sample.stamp_ns;
    pose.revision = sample.revision;
    return pose;
}

void SceneMailbox::note_heard(std::size_t object, MonotonicTime now) noexcept
{
    TACTUS_ASSERT(object < samples_.size());
    heard_ns_[object].store(now.ns, std::memory_order_relaxed);
}

std::span<const SceneChange> SceneMailbox::refresh(MonotonicTime now,
                                                   std::span<const ObjectTouch> touches) noexcept
{
    TACTUS_ASSERT(touches.size() <= kMaxPairs);
    touches_ = touches;
    for (const ObjectTouch& touch : touches)
    {
        blends_[touch.object].is_near = true;
        blends_[touch.object].exceeds_limit = false;
    }
    if (last_refresh_ == MonotonicTime{})
    {
        last_refresh_ = now;
    }
    std::size_t changes = take_scene_events();
    take_samples(now);
    check_ages(now);
    // Objects near tools move in every frame; otherwise the surface would jump under the tool. They
    // take at most half of the changes.
    const std::size_t passed = changes;
    for (const ObjectTouch& touch : touches)
    {
        std::uint64_t& bits = awake_[touch.object / kWordBits];
        const bool has_room = changes < changes_.size() && changes - passed < changes_.size() / 2;
        if (has_room && (bits & bit_of(touch.object)) != 0)
        {
            changes += try_move(touch.object, now, changes_[changes]) ? 1U : 0U;
            // Hidden from the visit of all objects below; set again after it if the object moved.
            bits &= ~bit_of(touch.object);
        }
    }
    const std::size_t touched = changes;
    // Visits each awake object once, from `first_` on. The word of `first_` comes first with its
    // later bits and last with its earlier ones.
    const std::size_t words = awake_.size();
    const std::uint64_t from_first = ~std::uint64_t{0} << first_ % kWordBits;
    std::size_t next = first_;
    for (std::size_t i = 0; i <= words && words > 0; ++i)
    {
        const std::size_t word = (first_ / kWordBits + i) % words;
        std::uint64_t bits = awake_[word];
        bits &= i == 0 ? from_first : i == words ? ~from_first : ~std::uint64_t{0};
        for (; bits != 0 && changes < changes_.size(); bits &= bits - 1)
        {
            const std::size_t object = first_of(word, bits);
            if (!try_move(object, now, changes_[changes]))
            {
                awake_[word] &= ~bit_of(object);
                continue;
            }
            ++changes;
            next = (object + 1) % samples_.size();
        }
    }
    for (std::size_t i = passed; i < touched; ++i)
    {
        awake_[changes_[i].number / kWordBits] |= bit_of(changes_[i].number);
    }
    for (const ObjectTouch& touch : touches)
    {
        blends_[touch.object].is_near = false;
    }
    first_ = next;
    last_refresh_ = now;
    return {changes_.data(), changes};
}

/// Takes the poses put since the last frame.
void SceneMailbox::take_samples(MonotonicTime now) noexcept
{
    for (std::size_t word = 0; word < unread_.size(); ++word)
    {
        if (came_[word].load(std::memory_order_relaxed) != 0)
        {
            // Pairs with the release in put(): a reader that sees the bit finds the sample.
            unread_[word] |= came_[word].exchange(0, std::memory_order_acquire);
        }
        for (std::uint64_t bits = unread_[word]; bits != 0; bits &= bits - 1)
        {
            const std::size_t object = first_of(word, bits);
            PoseSample sample;
            if (!mailboxes_[object].try_read(sample))
            {
                continue; // The sample is being written; the next frame reads it.
            }
            const PoseSample& last = samples_[object];
            if (sample.generation > last.generation)
            {
                continue; // The event that adds the object is still queued.
            }
            unread_[word] &= ~bit_of(object);
            // A sample for an earlier object of this number is too late.
            if (blends_[object].is_resident && sample.generation == last.generation &&
                sample.number > last.number)
            {
                begin_blend(object, sample, now);
                samples_[object] = sample;
                awake_[word] |= bit_of(object);
            }
        }
    }
}

void SceneMailbox::check_ages(MonotonicTime now) noexcept
{
    const std::size_t objects = samples_.size();
    // Number of frames in which each object's age is checked once.
    const std::size_t frames = (objects + kAgedAFrame - 1) / kAgedAFrame;
    for (std::size_t i = 0; i < std::min(objects, kAgedAFrame); ++i)
    {
        const std::size_t object = next_aged_;
        next_aged_ = next_aged_ + 1 == objects ? 0 : next_aged_ + 1;
        PoseUse& use = uses_[object];
        if (!use.is_followed)
        {
            continue;
        }
        const Duration age = age_of(object, now);
        use.age_max = std::max(use.age_max, age);
        use.old_frames += age > age_limit_ ? frames : 0U;
        if (blends_[object].is_told_old != is_silent(age))
        {
            awake_[object / kWordBits] |= bit_of(object);
        }
    }
}

/// Returns true and sets `change` if the frame needs a move of the object or news of its server.
bool SceneMailbox::try_move(std::size_t object, MonotonicTime now, SceneChange& change) noexcept
{
    const Duration age = age_of(object, now);
    Blend& blend = blends_[object];
    const bool has_news = blend.is_under_way || blend.is_told_old != is_silent(age);
    if (!has_news || !uses_[object].is_followed)
    {
        return false;
    }
    if (blend.is_under_way)
    {
        move_on(object, now);
    }
    blend.moved = now;
    blend.is_told_old = is_silent(age);
    change.kind = SceneChangeKind::object_moves;
    change.number = static_cast<std::uint32_t>(object);
    change.generation = samples_[object].generation;
    change.pose = ObjectPose{places_[object]};
    change.pose.stamp_ns = samples_[object].stamp_ns;
    change.pose.revision = samples_[object].revision;
    change.pose.arrival_ns = blend.is_told_old ? now.ns - age.ns : 0;
    return true;
}

/// Takes at most kTakenAFrame queue entries and puts their changes first. Returns their number;
/// other entries stay queued.
std::size_t SceneMailbox::take_scene_events() noexcept
{
    std::size_t changes = 0;
    SceneEvent scene_event;
    while (changes < kTakenAFrame && scene_events_.try_pop(scene_event))
    {
        const std::size_t object = scene_event.object;
        SceneChange& change = changes_[changes++];
        change = SceneChange{};
        change.number = scene_event.object;
        change.generation = scene_event.sample.generation;
        change.kind = scene_event.kind;
        change.object.material = scene_event.material;
        if (scene_event.kind == SceneChangeKind::object_feels)
        {
            continue;
        }
        const bool comes = scene_event.kind == SceneChangeKind::object_comes;
        blends_[object] = Blend{};
        blends_[object].is_resident = comes;
        uses_[object].is_followed = comes;
        if (!comes)
        {
            continue;
        }
        samples_[object] = scene_event.sample;
        change.object.model = ModelId{scene_event.model};
        change.pose = pose_of(scene_event.sample);
        places_[object] = Similarity{change.pose};
    }
    return changes;
}

void SceneMailbox::begin_blend(std::size_t object, const PoseSample& sample,
                               MonotonicTime now) noexcept
{
    const PoseSample& before = samples_[object];
    Blend& blend = blends_[object];
    blend.from = places_[object];
    blend.to = Similarity{pose_of(sample)};
    // True if the frame has not been given the last pose, which was to be taken at once. This pose
    // is then taken at once.
    const bool is_overdue = blend.is_under_way && blend.time == Duration{0};
    if (!blend.is_under_way)
    {
        blend.moved = last_refresh_;
    }
    const MonotonicTime start = std::min(blend.moved, now); // Time for which the frame has `from`.
    const Duration left = blend.is_under_way ? blend.time - (start - blend.start) : Duration{0};
    blend.start = start;
    blend.is_under_way = true;
    const bool has_stamps = sample.stamp_ns != 0 && before.stamp_ns != 0;
    const std::int64_t between_ns = has_stamps ? since_ns(before.stamp_ns, sample.stamp_ns)
                                               : sample.arrival_ns - before.arrival_ns;
    const bool rested = between_ns <= 0 || between_ns > kBlendMax.ns;
    const double way_m = (blend.to.translation_m - blend.from.translation_m).norm();
    const bool is_at_once = !uses_[object].is_followed || is_overdue || (rested && way_m > kJump_m);
    // If a pose is early, the last blend is unfinished: adding its remaining time keeps the speed.
    // A fifth of that time is dropped, so that one late pose causes no lasting lag.
    const std::int64_t whole_ns = between_ns + std::max<std::int64_t>(left.ns, 0) * 4 / 5;
    blend.time = is_at_once ? Duration{0}
                 : rested   ? kBlendMax
                            : Duration{std::min(whole_ns, kBlendMax.ns)};
    uses_[object].is_followed = true;
}

/// Moves an object of an unfinished blend to its place at `now`, within the object speed limit.
void SceneMailbox::move_on(std::size_t object, MonotonicTime now) noexcept
{
    Blend& blend = blends_[object];
    const Duration since = now - blend.moved;
    if (blend.is_held && !blend.is_near)
    {
        blend.from = places_[object];
        blend.start = blend.moved;
        blend.time = kBlendMax;
    }
    const Similarity wanted = place_at(blend, now);
    const double way_m = way_near_m(object, wanted);
    const double since_s = to_seconds(since);
    const bool is_too_fast = speed_limit_.is_too_fast(way_m, since_s);
    blend.exceeds_limit = speed_limit_.exceeds_limit(way_m, since_s);
    uses_[object].rate_limited_frames += is_too_fast ? 1U : 0U;
    blend.is_held = is_too_fast && (blend.time > Duration{0} || !blend.exceeds_limit);
    move_to(object, blend.is_held ? speed_limit_.held(places_[object], wanted, since_s,
                                                      [&](const Similarity& place)
                                                      { return way_near_m(object, place); })
                                  : wanted);
    blend.is_under_way = blend.is_held || now - blend.start < blend.time;
}

/// Largest displacement, from the present place to `to`, of the object's points that a tool may
/// meet; 0 if no tool is near.
double SceneMailbox::way_near_m(std::size_t object, const Similarity& to) const noexcept
{
    return blends_[object].is_near
               ? way_at_touches_m(touches_, static_cast<std::uint32_t>(object), places_[object], to)
               : 0.0;
}

Similarity SceneMailbox::place_at(const Blend& blend, MonotonicTime now) noexcept
{
    const Duration gone = now - blend.start;
    if (gone >= blend.time)
    {
        return blend.to;
    }
    return between(blend.from, blend.to,
                   static_cast<double>(gone.ns) / static_cast<double>(blend.time.ns));
}

Duration SceneMailbox::age_of(std::size_t object, MonotonicTime now) const noexcept
{
    // If the server was heard after the frame began, the age is 0.
    const std::int64_t heard_ns = heard_ns_[object].load(std::memory_order_relaxed);
    return {std::max<std::int64_t>(now.ns - heard_ns, 0)};
}

void SceneMailbox::move_to(std::size_t object, const Similarity& place) noexcept
{
    const Similarity& before = places_[object];
    PoseUse& use = uses_[object];
    const bool has_moved = place.translation_m != before.translation_m ||
                           place.rotation != before.rotation || place.scale != before.scale;
    use.moves += has_moved ? 1U : 0U;
    use.step_max_m = std::max(use.step_max_m, (place.translation_m - before.translation_m).norm());
    places_[object] = place;
}

} // namespace tactus
