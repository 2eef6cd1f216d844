// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hiding.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_hiding("hidden2/boxes", some_boxes<2>(3, 3, 200), 3);
    record_hiding("hidden2/bisected", refined(kuhn<2>(2), 7, 500), 1);
    return finish(count, arguments);
}
