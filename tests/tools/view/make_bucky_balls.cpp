// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes frames of a bucky ball that grows, first.nrrd, second.nrrd and third.nrrd.
// Arguments: the folder, samples along each direction.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include <bucky_ball.hpp>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const int n = std::atoi(argv[2]);
    std::vector<float> values = bucky_ball(n);
    for (const char* name : {"first", "second", "third"}) {
        std::ofstream file(std::string(argv[1]) + "/" + name + ".nrrd", std::ios::binary);
        file << "NRRD0004\ntype: float\ndimension: 3\nsizes: " << n << ' ' << n << ' ' << n
             << "\nspacings: 0.1 0.1 0.1\nencoding: raw\nendian: little\n\n";
        file.write(reinterpret_cast<const char*>(values.data()),
                   static_cast<std::streamsize>(values.size() * sizeof(float)));
        if (!file) return 1;
        for (float& v : values) v = std::pow(v, 0.8F);
    }
}
