// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tactus::test
{

/// Result of one claim that was tried many times: a line in the table of `tactus_bench stability`,
/// and the basis of a test's assertions.
struct TrialFigures
{
    /// Greatest number of violations kept as text.
    static constexpr std::size_t kTexts = 5;

    std::string name;
    std::uint64_t trials{0};
    double worst{0.0}; ///< Greatest error, in `unit`.
    double bound{1.0}; ///< Greatest allowed `worst`.
    std::string unit;
    std::uint64_t violations{0};
    std::vector<std::string> texts; ///< Texts that suffice to repeat the first violations.

    /// Adds an error; one that is not a number counts as infinite.
    void observe(double error)
    {
        worst =
            std::max(worst, std::isnan(error) ? std::numeric_limits<double>::infinity() : error);
    }
    void flag(const std::string& text)
    {
        ++violations;
        if (texts.size() < kTexts)
        {
            texts.push_back(text);
        }
    }
    /// Adds figures of the same claim from other trials.
    void add(const TrialFigures& other)
    {
        trials += other.trials;
        worst = std::max(worst, other.worst);
        violations += other.violations;
        for (const std::string& text : other.texts)
        {
            if (texts.size() < kTexts)
            {
                texts.push_back(text);
            }
        }
    }
    [[nodiscard]] bool holds() const { return violations == 0 && worst <= bound; }
    /// One line, and one more for each text.
    [[nodiscard]] std::string summary() const
    {
        std::string text = name + ": " + std::to_string(trials) + " trials, worst " +
                           std::to_string(worst) + " of " + std::to_string(bound) + " " + unit +
                           ", " + std::to_string(violations) + " violations";
        for (const std::string& one : texts)
        {
            text += "\n  " + one;
        }
        return text;
    }
};

} // namespace tactus::test
