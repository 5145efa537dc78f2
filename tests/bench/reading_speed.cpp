// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/reading_speed.hpp"

#include "rt_core/base/arena.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/linker.hpp"
#include "tests/bench/measuring.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace tactus::bench
{

namespace
{

/// Whole model, coded and decoded.
class WholeModel
{
public:
    explicit WholeModel(const ModelStore& store)
        : header_(store.header())
        , coded_(header_.counts().chunks())
        , pages_(header_.counts().chunks())
        , positions_m_(header_.counts().base_vertices)
        , faces_(header_.counts().base_faces)
        , next_(header_.counts().base_faces)
    {
        Arena measure = Arena::measuring();
        static_cast<void>(LinkPool(measure, pages_.size()));
        memory_.resize(measure.used() / sizeof(Line));
    }

    void load(const ModelStore& store)
    {
        std::vector<std::byte> base;
        for (std::uint32_t chunk = 0; chunk < coded_.size(); ++chunk)
        {
            needed(store.read({ContentKind::chunk, chunk}, coded_[chunk]));
        }
        needed(store.read({ContentKind::base, 0}, base));
        if (!parse_base_mesh(base, header_, slots().base))
        {
            throw Failure(store.path().string() + ": bad base mesh");
        }
    }

    /// True if every chunk was accepted.
    [[nodiscard]] bool parse_all()
    {
        bool is_sound = true;
        for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
        {
            is_sound &= bool{parse_chunk(coded_[chunk], header_, {chunk}, pages_[chunk])};
        }
        return is_sound;
    }

    [[nodiscard]] Linker make_linker()
    {
        std::fill(next_.begin(), next_.end(), kNextPending);
        Arena arena(std::as_writable_bytes(std::span(memory_)));
        pool_.emplace(arena, pages_.size());
        return {*pool_, 0, header_, slots()};
    }

    /// True if every record was linked.
    [[nodiscard]] bool link_all(Linker& linker) const
    {
        for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
        {
            linker.link_page({chunk}, chunk);
        }
        return linker.records_linked() == header_.counts().records;
    }

private:
    struct alignas(Arena::kAlignment) Line
    {
        std::array<std::byte, Arena::kAlignment> bytes;
    };

    [[nodiscard]] PageSlots slots() { return {pages_, {}, {positions_m_, faces_, next_}}; }

    const ModelHeader& header_;
    std::vector<std::vector<std::byte>> coded_;
    std::vector<Page> pages_;
    std::vector<Vec3f> positions_m_;
    std::vector<BaseFace> faces_;
    std::vector<std::uint32_t> next_;
    std::vector<Line> memory_;
    std::optional<LinkPool> pool_;
};

} // namespace

ReadingSpeed measure_reading(const ModelStore& store, std::uint32_t passes)
{
    const std::string name = store.path().string();
    const std::uint32_t records = store.header().counts().records;
    if (records == 0)
    {
        throw Failure(name + ": has no records to read");
    }
    WholeModel model(store);
    model.load(store);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    ReadingSpeed least{kNever, kNever, kNever};
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const BenchClock::time_point start = BenchClock::now();
        const bool is_parsed = model.parse_all();
        const BenchClock::time_point parsed = BenchClock::now();
        Linker linker = model.make_linker();
        const BenchClock::time_point ready = BenchClock::now();
        const bool is_linked = model.link_all(linker);
        const BenchClock::time_point linked = BenchClock::now();
        if (!is_parsed || !is_linked)
        {
            throw Failure(name + ": not all of its records can be read");
        }
        const double parse_ns = 1e9 * seconds(start, parsed) / records;
        const double link_ns = 1e9 * seconds(ready, linked) / records;
        least.parse_ns = std::min(least.parse_ns, parse_ns);
        least.link_ns = std::min(least.link_ns, link_ns);
        least.both_ns = std::min(least.both_ns, parse_ns + link_ns);
    }
    return least;
}

} // namespace tactus::bench
