// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/least_times.hpp"
#include "tests/bench/peers/pair_query.hpp"
#include "tests/bench/scenes.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench
{

enum class PairQuestion : std::uint8_t
{
    any,
    all_pairs,
    contacts,
    distance,
};
inline constexpr std::array kPairQuestions{PairQuestion::any, PairQuestion::all_pairs,
                                           PairQuestion::contacts, PairQuestion::distance};
[[nodiscard]] const char* question_name(PairQuestion question);

/// For each place of the tool: the pairs that meet, decided exactly, and the least distance. Faces
/// are named by their places in the sources, those with the same corners by the lowest of theirs.
struct PairTruth
{
    std::vector<std::vector<test::FacePair>> meeting; ///< Ascending.
    std::vector<double> distances_m;
    std::vector<std::uint32_t> tool_names; ///< Of each face of the source.
    std::vector<std::uint32_t> object_names;
};
/// Some milliseconds a place.
[[nodiscard]] PairTruth find_pair_truth(const Scene& tool, const Scene& object,
                                        std::span<const Similarity> places);

/// What one contestant said to one question at every place; what was not asked is empty.
struct PairAnswers
{
    LeastTimes us;
    std::vector<bool> do_meet;
    std::vector<std::vector<test::FacePair>> meeting; ///< By the sources' places.
    std::vector<double> distances_m;
    std::uint64_t hash{0}; ///< Over the answers: they were used.
};
/// Asks at all places in turn, `passes` times from the start, at the first one once before. Only
/// the question is timed. A failure only when passes differ.
[[nodiscard]] PairAnswers replay_pairs(PairQuery& query, std::span<const Similarity> places,
                                       PairQuestion question, std::uint32_t passes);

/// Frames for `any`, pairs for `all_pairs` and `contacts`; the largest error of a distance,
/// infinite for one that is not a number.
struct PairErrors
{
    std::uint64_t missed{0};
    std::uint64_t invented{0};
    double largest_m{0.0};
};
[[nodiscard]] PairErrors judge_pairs(const PairAnswers& answers, const PairTruth& truth,
                                     PairQuestion question);

} // namespace tactus::bench
