// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/posix_error.hpp"

#include <array>
#include <cerrno>
#include <pwd.h>
#include <unistd.h>

namespace tactus::posix
{

std::string name_of_error(int error)
{
    switch (error)
    {
    case EPERM:
        return "EPERM";
    case EINVAL:
        return "EINVAL";
    case ENOMEM:
        return "ENOMEM";
    case EAGAIN:
        return "EAGAIN";
    case ENOSYS:
        return "ENOSYS";
    case EADDRINUSE:
        return "EADDRINUSE";
    case EADDRNOTAVAIL:
        return "EADDRNOTAVAIL";
    default:
        return "errno " + std::to_string(error);
    }
}

std::string user_name()
{
    std::array<char, 4096> text{};
    passwd entry{};
    passwd* found = nullptr;
    const uid_t user = geteuid();
    if (getpwuid_r(user, &entry, text.data(), text.size(), &found) != 0 || found == nullptr)
    {
        return "uid " + std::to_string(user);
    }
    return found->pw_name;
}

} // namespace tactus::posix
