// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Loads the plugins that it is given, all at once and hidden from each other.
#include <dlfcn.h>

#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
    std::vector<int (*)()> plugins;
    for (int i = 1; i < argc; ++i) {
        void* const plugin = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
        if (plugin == nullptr) {
            std::printf("%s\n", dlerror());
            return 1;
        }
        plugins.push_back(reinterpret_cast<int (*)()>(dlsym(plugin, "refused")));
    }
    for (const auto refused : plugins) {
        if (refused == nullptr || refused() != 1) return 1;
    }
    return plugins.size() == 2 ? 0 : 1;
}
