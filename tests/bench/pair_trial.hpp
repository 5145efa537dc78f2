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

/// Meeting pairs, decided exactly, and the least distance for each pose of the tool. Faces are
/// named by their places in the sources; equal faces by the lowest place.
struct PairTruth
{
    std::vector<std::vector<test::FacePair>> meeting; ///< Ascending.
    std::vector<double> distances_m;
    std::vector<std::uint32_t> tool_names; ///< Name of each face of the source.
    std::vector<std::uint32_t> object_names;
};
/// Truth for all poses; some milliseconds each.
[[nodiscard]] PairTruth find_pair_truth(const Scene& tool, const Scene& object,
                                        std::span<const Similarity> places);

/// Answers of one contestant to one question for every pose; fields not asked for are empty.
struct PairAnswers
{
    LeastTimes us;
    std::vector<bool> do_meet;
    std::vector<std::vector<test::FacePair>> meeting; ///< Pairs by places in the sources.
    std::vector<double> distances_m;
    std::uint64_t hash{0}; ///< Hash of the answers, so that they are used.
};
/// Asks for all poses in turn, `passes` times; the first one once before. Only the question is
/// timed. A failure only if passes differ.
[[nodiscard]] PairAnswers replay_pairs(PairQuery& query, std::span<const Similarity> places,
                                       PairQuestion question, std::uint32_t passes);

/// Errors: frames for `any`, pairs for `all_pairs` and `contacts`; the greatest error of a
/// distance, infinite for one that is not a number.
struct PairErrors
{
    std::uint64_t missed{0};
    std::uint64_t invented{0};
    double largest_m{0.0};
};
[[nodiscard]] PairErrors judge_pairs(const PairAnswers& answers, const PairTruth& truth,
                                     PairQuestion question);

} // namespace tactus::bench
