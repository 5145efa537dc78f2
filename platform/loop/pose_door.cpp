// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/pose_door.hpp"

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

/// Object of a word's lowest bit.
constexpr std::size_t first_of(std::size_t word, std::uint64_t bits) noexcept
{
    return word * kWordBits + static_cast<std::size_t>(std::countr_zero(bits));
}

/// Time between two times of a host's clock, up to a day; otherwise 0, since a host's times are not
/// trusted.
std::int64_t since_ns(std::int64_t before_ns, std::int64_t now_ns) noexcept
{
    constexpr std::int64_t kDay_ns = 86'400'000'000'000;
    const bool is_time =
        now_ns > before_ns && (before_ns >= 0) == (now_ns >= 0) && now_ns - before_ns <= kDay_ns;
    return is_time ? now_ns - before_ns : 0;
}

} // namespace

PoseDoor::PoseDoor(std::span<const ObjectPose> placed, std::size_t objects, Duration age_limit,
                   double speed_max_m_per_s)
    : age_limit_(age_limit)
    , belief_{speed_max_m_per_s}
    , places_(placed.begin(), placed.end())
    , letters_(objects)
    , glides_(objects)
    , uses_(objects)
    , unread_(words_of(objects))
    , awake_(words_of(objects))
    , numbers_(objects)
    , generations_(objects)
    , passage_slots_(kWaiting)
    , passages_(passage_slots_)
    // NOLINTBEGIN(*-avoid-c-arrays)
    , mailboxes_(std::make_unique<Mailbox<Letter>[]>(objects))
    , heard_ns_(std::make_unique<std::atomic<std::int64_t>[]>(objects))
    , came_(std::make_unique<std::atomic<std::uint64_t>[]>(words_of(objects)))
// NOLINTEND(*-avoid-c-arrays)
{
    TACTUS_ASSERT(placed.size() <= objects);
    places_.resize(objects);
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
        glides_[i].is_here = true;
    }
}

bool PoseDoor::try_come(std::size_t object, std::uint32_t generation, const ObjectSpec& spec,
                        const ObjectPose& pose, MonotonicTime arrival) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    TACTUS_ASSERT(generation > generations_[object] || numbers_[object] == 0);
    if (passages_.size() == kWaiting)
    {
        return false;
    }
    generations_[object] = generation;
    Passage passage;
    passage.kind = SceneChangeKind::object_comes;
    passage.object = static_cast<std::uint32_t>(object);
    passage.letter = letter_of(object, pose, arrival);
    passage.model = spec.model.value;
    passage.material = spec.material;
    hear(object, arrival);
    return passages_.try_push(passage);
}

bool PoseDoor::try_go(std::size_t object) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    Passage passage;
    passage.object = static_cast<std::uint32_t>(object);
    passage.letter.generation = generations_[object];
    return passages_.try_push(passage);
}

bool PoseDoor::try_feel(std::size_t object, const Material& material) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    Passage passage;
    passage.kind = SceneChangeKind::object_feels;
    passage.object = static_cast<std::uint32_t>(object);
    passage.letter.generation = generations_[object];
    passage.material = material;
    return passages_.try_push(passage);
}

void PoseDoor::put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    mailboxes_[object].write(letter_of(object, pose, arrival));
    hear(object, arrival);
    // Pairs with the acquire in take_letters().
    came_[object / kWordBits].fetch_or(bit_of(object), std::memory_order_release);
}

PoseDoor::Letter PoseDoor::letter_of(std::size_t object, const ObjectPose& pose,
                                     MonotonicTime arrival) noexcept
{
    Letter letter;
    for (int i = 0; i < 9; ++i)
    {
        letter.rotation[static_cast<std::size_t>(i)] = pose.rotation(i / 3, i % 3);
    }
    const Vec3& at_m = pose.translation_m;
    letter.translation_m = {at_m.x(), at_m.y(), at_m.z()};
    letter.scale = pose.scale;
    letter.stamp_ns = pose.stamp_ns;
    letter.revision = pose.revision;
    letter.arrival_ns = arrival.ns;
    letter.generation = generations_[object];
    letter.number = ++numbers_[object];
    return letter;
}

ObjectPose PoseDoor::pose_of(const Letter& letter) noexcept
{
    ObjectPose pose;
    for (int i = 0; i < 9; ++i)
    {
        pose.rotation(i / 3, i % 3) = letter.rotation[static_cast<std::size_t>(i)];
    }
    const auto& at_m = letter.translation_m;
    pose.translation_m = Vec3(at_m[0], at_m[1], at_m[2]);
    pose.scale = letter.scale;
    pose.stamp_ns = letter.stamp_ns;
    pose.revision = letter.revision;
    return pose;
}

void PoseDoor::hear(std::size_t object, MonotonicTime now) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    heard_ns_[object].store(now.ns, std::memory_order_relaxed);
}

std::span<const SceneChange> PoseDoor::refresh(MonotonicTime now,
                                               std::span<const ObjectTouch> touches) noexcept
{
    TACTUS_ASSERT(touches.size() <= kMaxPairs);
    touches_ = touches;
    for (const ObjectTouch& touch : touches)
    {
        glides_[touch.object].is_near = true;
        glides_[touch.object].outruns = false;
    }
    if (last_refresh_ == MonotonicTime{})
    {
        last_refresh_ = now;
    }
    std::size_t changes = take_passages();
    take_letters(now);
    look_at_ages(now);
    // Objects near tools have their turn in every frame, or the surface would jump under the tool;
    // they leave half of the changes to others.
    const std::size_t passed = changes;
    for (const ObjectTouch& touch : touches)
    {
        std::uint64_t& bits = awake_[touch.object / kWordBits];
        const bool has_room = changes < changes_.size() && changes - passed < changes_.size() / 2;
        if (has_room && (bits & bit_of(touch.object)) != 0)
        {
            changes += try_move(touch.object, now, changes_[changes]) ? 1U : 0U;
            bits &= ~bit_of(touch.object); // This object has had its turn.
        }
    }
    const std::size_t touched = changes;
    // Visits all objects once from `first_` on: the later bits of its word first, the earlier ones
    // last.
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
            next = (object + 1) % letters_.size();
        }
    }
    for (std::size_t i = passed; i < touched; ++i)
    {
        awake_[changes_[i].number / kWordBits] |= bit_of(changes_[i].number);
    }
    for (const ObjectTouch& touch : touches)
    {
        glides_[touch.object].is_near = false;
    }
    first_ = next;
    last_refresh_ = now;
    return {changes_.data(), changes};
}

/// Takes the poses put since the last frame.
void PoseDoor::take_letters(MonotonicTime now) noexcept
{
    for (std::size_t word = 0; word < unread_.size(); ++word)
    {
        if (came_[word].load(std::memory_order_relaxed) != 0)
        {
            // Pairs with the release in put(): a reader that sees the bit finds the letter.
            unread_[word] |= came_[word].exchange(0, std::memory_order_acquire);
        }
        for (std::uint64_t bits = unread_[word]; bits != 0; bits &= bits - 1)
        {
            const std::size_t object = first_of(word, bits);
            Letter letter;
            if (!mailboxes_[object].try_read(letter))
            {
                continue; // The letter is being written; the next frame reads it.
            }
            const Letter& last = letters_[object];
            if (letter.generation > last.generation)
            {
                continue; // The object's own passage is still queued.
            }
            unread_[word] &= ~bit_of(object);
            // A letter for an earlier object of this number is too late.
            if (glides_[object].is_here && letter.generation == last.generation &&
                letter.number > last.number)
            {
                begin_glide(object, letter, now);
                letters_[object] = letter;
                awake_[word] |= bit_of(object);
            }
        }
    }
}

void PoseDoor::look_at_ages(MonotonicTime now) noexcept
{
    const std::size_t objects = letters_.size();
    // Frames until each object has its next turn.
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
        if (glides_[object].is_told_old != is_silent(age))
        {
            awake_[object / kWordBits] |= bit_of(object);
        }
    }
}

/// Returns true, with the change, if the frame needs a change of the object.
bool PoseDoor::try_move(std::size_t object, MonotonicTime now, SceneChange& change) noexcept
{
    const Duration age = age_of(object, now);
    Glide& glide = glides_[object];
    const bool has_news = glide.is_under_way || glide.is_told_old != is_silent(age);
    if (!has_news || !uses_[object].is_followed)
    {
        return false;
    }
    if (glide.is_under_way)
    {
        move_on(object, now);
    }
    glide.moved = now;
    glide.is_told_old = is_silent(age);
    change.kind = SceneChangeKind::object_moves;
    change.number = static_cast<std::uint32_t>(object);
    change.generation = letters_[object].generation;
    change.pose = ObjectPose{places_[object]};
    change.pose.stamp_ns = letters_[object].stamp_ns;
    change.pose.revision = letters_[object].revision;
    change.pose.arrival_ns = glide.is_told_old ? now.ns - age.ns : 0;
    return true;
}

/// Takes added, removed and changed objects before the moves; returns their number of changes. More
/// are deferred to the next frame.
std::size_t PoseDoor::take_passages() noexcept
{
    std::size_t changes = 0;
    Passage passage;
    while (changes < kTakenAFrame && passages_.try_pop(passage))
    {
        const std::size_t object = passage.object;
        SceneChange& change = changes_[changes++];
        change = SceneChange{};
        change.number = passage.object;
        change.generation = passage.letter.generation;
        change.kind = passage.kind;
        change.object.material = passage.material;
        if (passage.kind == SceneChangeKind::object_feels)
        {
            continue;
        }
        const bool comes = passage.kind == SceneChangeKind::object_comes;
        glides_[object] = Glide{};
        glides_[object].is_here = comes;
        uses_[object].is_followed = comes;
        if (!comes)
        {
            continue;
        }
        letters_[object] = passage.letter;
        change.object.model = ModelId{passage.model};
        change.pose = pose_of(passage.letter);
        places_[object] = Similarity{change.pose};
    }
    return changes;
}

void PoseDoor::begin_glide(std::size_t object, const Letter& letter, MonotonicTime now) noexcept
{
    const Letter& before = letters_[object];
    Glide& glide = glides_[object];
    glide.from = places_[object];
    glide.to = Similarity{pose_of(letter)};
    // If the frame has not been given a pose that was to be taken at once, this one is taken at
    // once.
    const bool is_overdue = glide.is_under_way && glide.time == Duration{0};
    if (!glide.is_under_way)
    {
        glide.moved = last_refresh_;
    }
    const MonotonicTime start = std::min(glide.moved, now); // The object was due there then.
    const Duration left = glide.is_under_way ? glide.time - (start - glide.start) : Duration{0};
    glide.start = start;
    glide.is_under_way = true;
    const bool has_stamps = letter.stamp_ns != 0 && before.stamp_ns != 0;
    const std::int64_t between_ns = has_stamps ? since_ns(before.stamp_ns, letter.stamp_ns)
                                               : letter.arrival_ns - before.arrival_ns;
    const bool rested = between_ns <= 0 || between_ns > kGlideMax.ns;
    const double way_m = (glide.to.translation_m - glide.from.translation_m).norm();
    const bool is_at_once = !uses_[object].is_followed || is_overdue || (rested && way_m > kJump_m);
    // If a pose is early, the blend before is not finished: adding its remaining time keeps the
    // speed. A fifth of that time is dropped, so that one late pose causes no lasting lag.
    const std::int64_t whole_ns = between_ns + std::max<std::int64_t>(left.ns, 0) * 4 / 5;
    glide.time = is_at_once ? Duration{0}
                 : rested   ? kGlideMax
                            : Duration{std::min(whole_ns, kGlideMax.ns)};
    uses_[object].is_followed = true;
}

/// Moves an object in motion by one frame.
void PoseDoor::move_on(std::size_t object, MonotonicTime now) noexcept
{
    Glide& glide = glides_[object];
    const Duration since = now - glide.moved;
    if (glide.is_held && !glide.is_near)
    {
        glide.from = places_[object];
        glide.start = glide.moved;
        glide.time = kGlideMax;
    }
    const Similarity wanted = place_at(glide, now);
    const double way_m = way_near_m(object, wanted);
    const double since_s = to_seconds(since);
    const bool is_too_fast = belief_.is_too_fast(way_m, since_s);
    glide.outruns = belief_.outruns(way_m, since_s);
    uses_[object].outran_frames += is_too_fast ? 1U : 0U;
    glide.is_held = is_too_fast && (glide.time > Duration{0} || !glide.outruns);
    move_to(object, glide.is_held ? belief_.held(places_[object], wanted, since_s,
                                                 [&](const Similarity& place)
                                                 { return way_near_m(object, place); })
                                  : wanted);
    glide.is_under_way = glide.is_held || now - glide.start < glide.time;
}

/// Largest displacement of the parts of the object that a tool may meet; 0 if no tool is near.
double PoseDoor::way_near_m(std::size_t object, const Similarity& to) const noexcept
{
    double way_m = 0.0;
    for (std::size_t i = 0; i < touches_.size() && glides_[object].is_near; ++i)
    {
        const ObjectTouch& touch = touches_[i];
        if (touch.object == object)
        {
            way_m =
                std::max(way_m, way_in_ball_m(places_[object], to, touch.place_m, touch.radius_m));
        }
    }
    return way_m;
}

Similarity PoseDoor::place_at(const Glide& glide, MonotonicTime now) noexcept
{
    const Duration gone = now - glide.start;
    if (gone >= glide.time)
    {
        return glide.to;
    }
    return between(glide.from, glide.to,
                   static_cast<double>(gone.ns) / static_cast<double>(glide.time.ns));
}

Duration PoseDoor::age_of(std::size_t object, MonotonicTime now) const noexcept
{
    // A host may have been heard since the frame began; its age is 0.
    const std::int64_t heard_ns = heard_ns_[object].load(std::memory_order_relaxed);
    return {std::max<std::int64_t>(now.ns - heard_ns, 0)};
}

void PoseDoor::move_to(std::size_t object, const Similarity& place) noexcept
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
