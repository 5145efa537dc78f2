// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/doctor.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace tactus::doctor
{
namespace
{

std::vector<Finding> one_of_each()
{
    return {{"a", Verdict::good, "all is well", "It matters.", {}},
            {"b", Verdict::advice, "so-so", "It helps.", {"restore b", "and b again"}},
            {"c", Verdict::critical, "broken", "It must be.", {"restore c"}},
            {"d", Verdict::unknown, "/d is not there", "It may be.", {"ls -l /d"}}};
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
    {
        lines.push_back(line);
    }
    return lines;
}

TEST(DoctorReport, holds_every_finding)
{
    const std::vector<Finding> findings = one_of_each();
    const auto report = nlohmann::json::parse(make_report(findings, 3).dump());
    EXPECT_EQ(report["schema"], 1);
    EXPECT_EQ(report["cpu"], 3);
    EXPECT_EQ(report["counts"],
              nlohmann::json::parse(R"({"good":1,"advice":1,"critical":1,"unknown":1})"));
    ASSERT_EQ(report["checks"].size(), findings.size());
    for (std::size_t i = 0; i < findings.size(); ++i)
    {
        const auto& check = report["checks"][i];
        EXPECT_EQ(check["name"], findings[i].name);
        EXPECT_EQ(check["verdict"], kVerdictNames[i]);
        EXPECT_EQ(check["found"], findings[i].found);
        EXPECT_EQ(check["why"], findings[i].why);
        EXPECT_EQ(check["remedy"], nlohmann::json(findings[i].remedy));
    }
    EXPECT_TRUE(make_report(findings, std::nullopt)["cpu"].is_null());
}

TEST(DoctorReport, shows_what_was_asked_for_even_when_it_is_good)
{
    std::vector<Finding> findings{{"a", Verdict::good, "all is well", "It matters.", {}},
                                  {"b", Verdict::good, "x is heard", "It is found.", {}}};
    findings[1].is_asked_for = true;
    EXPECT_EQ(make_text(findings, false), "0 critical, 0 unknown, 0 advice, 2 good\n\n"
                                          "good      b                  x is heard\n"
                                          "                             It is found.\n\n"
                                          "good                         a\n");
}

TEST(DoctorReport, shows_the_worst_first_and_what_is_good_when_asked)
{
    const std::string bad = "1 critical, 1 unknown, 1 advice, 1 good\n\n"
                            "critical  c                  broken\n"
                            "                             It must be.\n"
                            "                             $ restore c\n\n"
                            "unknown   d                  /d is not there\n"
                            "                             It may be.\n"
                            "                             $ ls -l /d\n\n"
                            "advice    b                  so-so\n"
                            "                             It helps.\n"
                            "                             $ restore b\n"
                            "                             $ and b again\n\n";
    EXPECT_EQ(make_text(one_of_each(), true), bad + "good      a                  all is well\n"
                                                    "                             It matters.\n");
    std::vector<Finding> findings = one_of_each();
    findings.push_back({"e", Verdict::good, "fine", "It matters, too.", {}});
    EXPECT_EQ(make_text(findings, false), "1 critical, 1 unknown, 1 advice, 2 good" +
                                              bad.substr(bad.find('\n')) +
                                              "good                         a, e\n");
}

TEST(DoctorReport, fits_100_columns_but_for_commands)
{
    MadeUpMachine machine;
    for (const bool good : {false, true})
    {
        if (good)
        {
            make_good(machine);
        }
        for (const std::string& line : lines_of(make_text(examine(machine.view()), true)))
        {
            EXPECT_TRUE(line.size() <= 100 || line.find(" $ ") != std::string::npos) << line;
            EXPECT_FALSE(line.ends_with(' ')) << line;
        }
    }
}

TEST(DoctorReport, loses_no_letter_where_it_breaks_lines)
{
    for (const std::size_t length : {1U, 70U, 71U, 72U, 142U, 143U, 500U})
    {
        const std::string word(length, 'x');
        const std::string text =
            make_text({{"a", Verdict::good, word, word + " " + word, {}}}, true);
        EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, 'x')), 3 * length);
        for (const std::string& line : lines_of(text))
        {
            EXPECT_LE(line.size(), 100U) << line;
        }
    }
}

} // namespace
} // namespace tactus::doctor
