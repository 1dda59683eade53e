/* The same as driver.cpp through the C interface, in C99. */
#include HEADER

#include <stdio.h>
#include <stdlib.h>

#define PASTE(a, b) a##b
#define JOIN(a, b) PASTE(a, b)
#define NAME(word) JOIN(ARM, word)

#ifndef LOCKED
#define LOCKED 0
#endif
#if LOCKED
#define ASK(goal, found) NAME(_ik)(goal, goal + 16, 0, found)
#else
#define ASK(goal, found) NAME(_ik)(goal, 0, found)
#endif

int main(void) {
    int n = 0, j, k;
    if (fread(&n, sizeof n, 1, stdin) != 1) return 2;
    for (k = 0; k < n; ++k) {
        double goal[16 + LOCKED];
        NAME(_solutions) found;
        int head[3];
        if (fread(goal, sizeof(double), 16 + LOCKED, stdin) != 16 + LOCKED) return 2;
        head[0] = ASK(goal, &found);
        head[1] = (int)found.status;
        head[2] = found.complete;
        fwrite(head, sizeof(int), 3, stdout);
        for (j = 0; j < found.count; ++j) {
            double T[16], J[6 * NAME(_dof)];
            const int family = found.self_motion[j];
            NAME(_fk)(found.q[j], T);
            NAME(_jacobian)(found.q[j], J);
            fwrite(found.q[j], sizeof(double), NAME(_dof), stdout);
            fwrite(&family, sizeof(int), 1, stdout);
            fwrite(T, sizeof(double), 16, stdout);
            fwrite(J, sizeof(double), 6 * NAME(_dof), stdout);
        }
    }
    return 0;
}
