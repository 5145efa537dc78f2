// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/pair_trial.hpp"

#include "tests/bench/measuring.hpp"
#include "tests/shared/face_names.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

namespace tactus::bench
{

namespace
{

std::vector<std::uint32_t> names_of(const Scene& scene)
{
    const test::FaceNames names(scene.model.faces);
    std::vector<std::uint32_t> all(scene.model.faces.size());
    for (std::uint32_t face = 0; face < all.size(); ++face)
    {
        all[face] = names.of(face);
    }
    return all;
}

/// Names of the pairs, ascending and unique.
std::vector<test::FacePair> named(const std::vector<test::FacePair>& pairs, const PairTruth& truth)
{
    std::vector<test::FacePair> names;
    for (const test::FacePair& pair : pairs)
    {
        names.push_back({truth.tool_names[pair.tool_face], truth.object_names[pair.face]});
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::uint64_t missing_from(const std::vector<test::FacePair>& those,
                           const std::vector<test::FacePair>& wanted)
{
    std::vector<test::FacePair> missing;
    std::ranges::set_difference(wanted, those, std::back_inserter(missing));
    return missing.size();
}

/// Asks one question; keeps the answer and returns its hash.
std::uint64_t answer(PairQuery& query, PairQuestion question, std::size_t frame,
                     PairAnswers& answers)
{
    const BenchClock::time_point start = BenchClock::now();
    switch (question)
    {
    case PairQuestion::any:
    {
        const bool do_meet = query.do_meet();
        answers.us.keep(frame, microseconds(start, BenchClock::now()));
        answers.do_meet[frame] = do_meet;
        return do_meet ? 1 : 0;
    }
    case PairQuestion::all_pairs:
    case PairQuestion::contacts:
    {
        const std::vector<test::FacePair>& pairs =
            question == PairQuestion::contacts ? query.contacts() : query.meeting();
        answers.us.keep(frame, microseconds(start, BenchClock::now()));
        answers.meeting[frame].clear();
        std::uint64_t sum = pairs.size();
        for (const test::FacePair& pair : pairs)
        {
            answers.meeting[frame].push_back(query.in_source(pair));
            sum += (std::uint64_t{pair.tool_face} << 32U) + pair.face; // Independent of the order.
        }
        return sum;
    }
    case PairQuestion::distance:
        break;
    }
    const double distance_m = query.distance_m();
    answers.us.keep(frame, microseconds(start, BenchClock::now()));
    answers.distances_m[frame] = distance_m;
    return std::bit_cast<std::uint64_t>(distance_m);
}

bool asks_for_pairs(PairQuestion question)
{
    return question == PairQuestion::all_pairs || question == PairQuestion::contacts;
}

PairAnswers room_for(PairQuestion question, std::size_t frames)
{
    PairAnswers answers{LeastTimes(frames), {}, {}, {}};
    answers.do_meet.resize(question == PairQuestion::any ? frames : 0);
    answers.meeting.resize(asks_for_pairs(question) ? frames : 0);
    answers.distances_m.resize(question == PairQuestion::distance ? frames : 0);
    return answers;
}

} // namespace

const char* question_name(PairQuestion question)
{
    return question == PairQuestion::any         ? "any"
           : question == PairQuestion::all_pairs ? "all pairs"
           : question == PairQuestion::contacts  ? "contacts"
                                                 : "distance";
}

PairTruth find_pair_truth(const Scene& tool, const Scene& object,
                          std::span<const Similarity> places)
{
    PairTruth truth;
    truth.tool_names = names_of(tool);
    truth.object_names = names_of(object);
    test::MeshPairOracle oracle(tool.model, object.model);
    for (const Similarity& place : places)
    {
        ToolState state;
        state.position_m = place.translation_m;
        state.rotation = place.rotation;
        oracle.place(ObjectPose{}, state);
        truth.meeting.push_back(named(oracle.meeting(), truth));
        const bool do_meet = !truth.meeting.back().empty();
        truth.distances_m.push_back(do_meet ? 0.0
                                            : static_cast<double>(oracle.nearest().distance_m));
    }
    return truth;
}

PairAnswers replay_pairs(PairQuery& query, std::span<const Similarity> places,
                         PairQuestion question, std::uint32_t passes)
{
    PairAnswers answers = room_for(question, places.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        std::uint64_t hash = 0;
        query.forget();
        if (!places.empty())
        {
            query.place(places[0]);
            PairAnswers not_kept = room_for(question, 1);
            static_cast<void>(answer(query, question, 0, not_kept));
        }
        for (std::size_t i = 0; i < places.size(); ++i)
        {
            query.place(places[i]);
            hash += answer(query, question, i, answers) * (2 * i + 1);
        }
        if (pass > 0 && hash != answers.hash)
        {
            throw Failure(query.name() + ": passes over the same places gave other answers");
        }
        answers.hash = hash;
    }
    return answers;
}

PairErrors judge_pairs(const PairAnswers& answers, const PairTruth& truth, PairQuestion question)
{
    PairErrors errors;
    for (std::size_t i = 0; i < truth.meeting.size(); ++i)
    {
        const bool do_meet = !truth.meeting[i].empty();
        if (question == PairQuestion::any)
        {
            errors.missed += do_meet && !answers.do_meet[i] ? 1U : 0U;
            errors.invented += !do_meet && answers.do_meet[i] ? 1U : 0U;
        }
        else if (asks_for_pairs(question))
        {
            const std::vector<test::FacePair> told = named(answers.meeting[i], truth);
            errors.missed += missing_from(told, truth.meeting[i]);
            errors.invented += missing_from(truth.meeting[i], told);
        }
        else
        {
            const double error_m = std::abs(answers.distances_m[i] - truth.distances_m[i]);
            errors.largest_m = std::isnan(error_m) ? std::numeric_limits<double>::infinity()
                                                   : std::max(errors.largest_m, error_m);
        }
    }
    return errors;
}

} // namespace tactus::bench
