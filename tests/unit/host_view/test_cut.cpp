// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/extract.hpp"
#include "host_tools/encode/replay.hpp"
#include "host_tools/spm_view/cut.hpp"
#include "rt_core/spm/error_code.hpp"
#include "tests/unit/host_view/settled_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tactus::view
{
namespace
{

using Corner = std::array<float, 3>;
using Triangle3 = std::array<Corner, 3>;

/// Decoded cut, as the page reads it.
struct ReadCut
{
    std::vector<Triangle3> faces;
    std::vector<float> errors_m;
    std::vector<std::uint16_t> levels;
};

ReadCut read(const std::string& bytes)
{
    std::size_t at = 0;
    const auto take = [&]<typename T>(T example, std::size_t count)
    {
        std::vector<T> values(count, example);
        EXPECT_LE(at + count * sizeof(T), bytes.size());
        std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
        at += count * sizeof(T);
        return values;
    };
    const auto counts = take(std::uint32_t{}, 2);
    const auto positions = take(Corner{}, counts[0]);
    const auto corners = take(std::array<std::uint32_t, 3>{}, counts[1]);
    ReadCut cut;
    cut.errors_m = take(float{}, counts[1]);
    cut.levels = take(std::uint16_t{}, counts[1]);
    EXPECT_EQ(bytes.size() - at, counts[1] % 2 * 2);
    for (const auto& face : corners)
    {
        cut.faces.push_back({positions.at(face[0]), positions.at(face[1]), positions.at(face[2])});
    }
    return cut;
}

/// The same face from its least corner.
Triangle3 from_least_corner(Triangle3 face)
{
    std::rotate(face.begin(), std::ranges::min_element(face), face.end());
    return face;
}

struct Opened
{
    explicit Opened(const tactus::test::TestModel& model)
        : store(std::move(ModelStore::open(model.path)).value())
        , decoded(DecodedModel::decode(store, damage))
    {
        EXPECT_TRUE(damage.empty());
    }
    ModelStore store;
    std::vector<std::string> damage;
    DecodedModel decoded;
};

std::vector<RefinementStatePage> pages_of(const std::set<std::uint32_t>& records)
{
    std::map<std::uint32_t, std::uint64_t> bits;
    for (const std::uint32_t record : records)
    {
        bits[record / kRecordsPerChunk] |= std::uint64_t{1} << (record % kRecordsPerChunk);
    }
    std::vector<RefinementStatePage> pages;
    for (const auto& [chunk, refined] : bits)
    {
        pages.push_back({{chunk}, refined});
    }
    return pages;
}

/// Splits all faces with a larger bound, with dependencies, until there is none.
std::set<std::uint32_t> records_for(const DecodedModel& model, double error_m)
{
    constexpr std::uint32_t base = 0xFFFF'FFFFU;
    const double quantum_m = static_cast<double>(model.header().quantum_m());
    const auto made_by = [](FaceState state)
    { return state.is_base() ? base : state.record().value; };
    // Next record by face and its creator.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> next;
    for (std::uint32_t id = 0; id < model.header().counts().records; ++id)
    {
        const VsplitRecord& record = model.record({id});
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            next[{record.star[2 + i].value, made_by(record.before[i])}] = id;
        }
    }
    std::set<std::uint32_t> taken;
    std::vector<std::uint32_t> open;
    const auto leave_if_coarse = [&](FaceId face, FaceState state)
    {
        const float error = error_in_quanta(model.error_of(face, state));
        if (static_cast<double>(error) * quantum_m > error_m)
        {
            open.push_back(next.at({face.value, made_by(state)}));
        }
    };
    for (std::uint32_t face = 0; face < model.header().counts().base_faces; ++face)
    {
        leave_if_coarse({face}, FaceState::base());
    }
    while (!open.empty())
    {
        const std::uint32_t id = open.back();
        open.pop_back();
        if (!taken.insert(id).second)
        {
            continue;
        }
        const VsplitRecord& record = model.record({id});
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (!record.before[i].is_base())
            {
                open.push_back(record.before[i].record().value);
            }
        }
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            if (!record.star[place].is_none())
            {
                leave_if_coarse(record.star[place], FaceState::after({id}, place));
            }
        }
    }
    return taken;
}

TEST(Cut, is_face_for_face_what_spm_inspect_extracts)
{
    for (const tactus::test::TestModel* model : tactus::test::small_models())
    {
        const Opened opened(*model);
        for (const double share : {0.0, 1e-4, 1e-3, 1e-2, 1.0})
        {
            SCOPED_TRACE(model->name + " " + std::to_string(share));
            const double error_m = share * model->diagonal_m;
            const Extraction expected = extract(opened.decoded, {{}, error_m, {}});
            const auto bytes =
                cut_bytes(opened.decoded, pages_of(records_for(opened.decoded, error_m)));
            ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
            const ReadCut cut = read(bytes.value());
            ASSERT_EQ(cut.faces.size(), expected.mesh.faces.size());
            for (std::size_t i = 0; i < cut.faces.size(); ++i)
            {
                for (std::size_t corner = 0; corner < 3; ++corner)
                {
                    const auto& at = expected.mesh.positions[expected.mesh.faces[i][corner]];
                    for (std::size_t axis = 0; axis < 3; ++axis)
                    {
                        ASSERT_EQ(model->origin_m[axis] +
                                      static_cast<double>(cut.faces[i][corner][axis]),
                                  at[axis])
                            << i;
                    }
                }
            }
            EXPECT_DOUBLE_EQ(static_cast<double>(*std::ranges::max_element(cut.errors_m)),
                             expected.error_max_m);
        }
    }
}

/// Conversion of a frame's page table to the faces of its forest.
TEST(Cut, is_face_for_face_what_the_controller_has)
{
    const Opened opened(tactus::test::small_model(0));
    const auto rig = test::settled_rig();
    const Model& made = rig->model();
    const std::vector<RefinementStatePage> pages = test::pages_of(made);
    std::size_t records = 0;
    for (const RefinementStatePage& page : pages)
    {
        records += static_cast<std::size_t>(std::popcount(page.refined));
    }
    ASSERT_EQ(records, made.forest.refined_records());
    ASSERT_GT(records, 0U);
    const auto bytes = cut_bytes(opened.decoded, pages);
    ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
    std::vector<Triangle3> shown;
    for (const Triangle3& face : read(bytes.value()).faces)
    {
        shown.push_back(from_least_corner(face));
    }
    std::vector<Triangle3> touched;
    for (std::uint32_t id = 0; id < made.header.counts().face_ids(); ++id)
    {
        if (const PrimId prim = made.forest.find(FaceId{id}); !prim.is_none())
        {
            Triangle3 face;
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                const Vec3f& at = opened.decoded.position_m(made.forest.face(prim).corners[corner]);
                face[corner] = {at[0], at[1], at[2]};
            }
            touched.push_back(from_least_corner(face));
        }
    }
    std::ranges::sort(shown);
    std::ranges::sort(touched);
    EXPECT_EQ(shown.size(), made.forest.active_faces());
    EXPECT_EQ(shown, touched);
}

TEST(Cut, has_the_faces_that_edits_left_and_added)
{
    const Opened opened(tactus::test::small_model(0));
    const std::vector<RefinementStatePage> all = pages_of(records_for(opened.decoded, 0.0));
    const auto before = cut_bytes(opened.decoded, all);
    ASSERT_TRUE(before.has_value());
    std::optional<FaceId> source; // Any source face.
    Replay replay(opened.decoded);
    ASSERT_FALSE(split_all(replay, opened.decoded, all));
    for (std::uint32_t face = 0; face < opened.decoded.header().counts().face_ids(); ++face)
    {
        if (replay.is_active({face}))
        {
            source = FaceId{face};
        }
    }
    ASSERT_TRUE(source);
    const Triangle3 added{Corner{0.0F, 0.0F, 0.0F}, Corner{1.0F, 0.0F, 0.0F},
                          Corner{0.0F, 1.0F, 0.0F}};
    EditContent edit;
    edit.revision = 1;
    edit.removed = {*source};
    edit.added = {
        {3, 0, {Vec3f{0.0F, 0.0F, 0.0F}, Vec3f{1.0F, 0.0F, 0.0F}, Vec3f{0.0F, 1.0F, 0.0F}}}};
    edit.removed_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}};
    EditState edits(opened.decoded.header().counts(), 8);
    edits.apply(edit);
    const auto after = cut_bytes(opened.decoded, all, &edits);
    ASSERT_TRUE(after.has_value());
    std::vector<Triangle3> old = read(before.value()).faces;
    std::vector<Triangle3> shown = read(after.value()).faces;
    ASSERT_EQ(shown.size(), old.size());
    EXPECT_EQ(shown.back(), added);
    shown.pop_back();
    old.pop_back(); // The active face with the greatest id is the last one.
    EXPECT_EQ(shown, old);
}

TEST(Cut, refuses_records_that_the_model_does_not_have_or_that_lack_what_they_depend_on)
{
    const Opened opened(tactus::test::small_model(0));
    const std::uint32_t records = opened.decoded.header().counts().records;
    const auto last = in_dependency_order(opened.decoded).back().value;
    EXPECT_TRUE(cut_bytes(opened.decoded, {}).has_value());
    EXPECT_FALSE(cut_bytes(opened.decoded, pages_of({records})).has_value());
    EXPECT_FALSE(cut_bytes(opened.decoded, pages_of({0xFFFF'FF00U})).has_value());
    EXPECT_FALSE(cut_bytes(opened.decoded, pages_of({last})).has_value());
    const test::Shelved shelved;
    EXPECT_TRUE(decode_cut(*shelved.known, {}).has_value());
    EXPECT_FALSE(decode_cut(*shelved.known, pages_of({records})).has_value());
    EXPECT_FALSE(decode_cut(*shelved.known, pages_of({0xFFFF'FF00U})).has_value());
    EXPECT_FALSE(decode_cut(*shelved.known, pages_of({last})).has_value());
}

/// Every fourth page is missing: all records that can be split without it are split.
TEST(Cut, of_a_part_of_the_pages_is_all_that_can_be_split_with_them)
{
    const tactus::test::TestModel& model = tactus::test::small_model(0);
    const Opened opened(model);
    const std::vector<RefinementStatePage> whole =
        pages_of(records_for(opened.decoded, 1e-3 * model.diagonal_m));
    EXPECT_EQ(cut_id(splittable_part(opened.decoded, whole)), cut_id(whole));
    std::vector<RefinementStatePage> told;
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
        if (i % 4 != 1)
        {
            told.push_back(whole[i]);
        }
    }
    EXPECT_FALSE(cut_bytes(opened.decoded, told).has_value());
    const test::Shelved shelved(model);
    EXPECT_FALSE(decode_cut(*shelved.known, told).has_value());
    const auto decoded = decode_cut(*shelved.known, told, false); // Missing pages are ignored.
    ASSERT_TRUE(decoded.has_value()) << decoded.error().text;
    const std::vector<RefinementStatePage> part = splittable_part(decoded.value(), told);
    const auto shown = cut_bytes(decoded.value(), part);
    ASSERT_TRUE(shown.has_value()) << shown.error().text;
    EXPECT_EQ(shown.value(), cut_bytes(opened.decoded, part).value());
    ASSERT_EQ(part.size(), told.size());
    std::size_t split = 0;
    std::size_t left = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
        EXPECT_EQ(part[i].chunk, told[i].chunk);
        EXPECT_EQ(part[i].refined & ~told[i].refined, 0U);
        split += static_cast<std::size_t>(std::popcount(part[i].refined));
        for (std::uint64_t bits = told[i].refined & ~part[i].refined; bits != 0; bits &= bits - 1)
        {
            std::vector<RefinementStatePage> more = part;
            more[i].refined |= bits & -bits;
            EXPECT_FALSE(cut_bytes(opened.decoded, more).has_value()) << i;
            ++left;
        }
    }
    EXPECT_GT(split, 0U);
    EXPECT_GT(left, 0U);
}

TEST(Cut, has_a_name_that_pages_without_split_records_do_not_change)
{
    const std::vector<RefinementStatePage> one{{{1}, 5}};
    EXPECT_EQ(cut_id(one), cut_id(std::vector<RefinementStatePage>{{{0}, 0}, {{1}, 5}, {{7}, 0}}));
    EXPECT_NE(cut_id(one), cut_id(std::vector<RefinementStatePage>{{{1}, 4}}));
    EXPECT_NE(cut_id(one), cut_id(std::vector<RefinementStatePage>{{{2}, 5}}));
    EXPECT_NE(cut_id(one), cut_id({}));
}

} // namespace
} // namespace tactus::view
