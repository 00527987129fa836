/* An alignment in C: Horn's closed form, whose eigenvector is found by squaring the matrix. */
#include "seeone_alignment.h"

static SeeoneStatus horn(const SeeonePairs *pairs, SeeoneFound *found, SeeoneMessage *message) {
    double s[3][3] = {{0}}, q[3][3] = {{0}}, spread = 0, square = 0, norm = 0, R[3][3];
    for (uint64_t i = 0; i < pairs->count; i++)
        for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) {
            double x = pairs->source[3 * i + r] - pairs->source_middle[r];
            s[r][c] += pairs->weight[i] * x * (pairs->target[3 * i + c] - pairs->target_middle[c]);
            q[r][c] += pairs->weight[i] * x * (pairs->source[3 * i + c] - pairs->source_middle[c]);
        }
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) square += q[r][c] * q[r][c];
    for (int r = 0; r < 3; r++) spread += q[r][r];
    found->condition = 1 - square / (spread * spread); /* zero for points on one line */
    if (!(found->condition > 1e-9)) return seeone_refuse(message, SeeoneStatus_INPUT, "one line");
    double p[4][4] = {{s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2], s[1][2] - s[2][1]},
                      {s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1], s[2][0] - s[0][2]},
                      {s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1], s[0][1] - s[1][0]},
                      {s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0], s[0][0] + s[1][1] + s[2][2]}};
    for (int r = 0; r < 4; r++) for (int c = 0; c < 4; c++) norm += p[r][c] * p[r][c];
    for (int r = 0; r < 4; r++) p[r][r] += sqrt(norm); /* no eigenvalue below zero */
    for (int round = 0; round < 12; round++) {         /* to the power of 4096 */
        double next[4][4] = {{0}}, trace = 0;
        for (int r = 0; r < 4; r++) for (int c = 0; c < 4; c++) for (int j = 0; j < 4; j++) next[r][c] += p[r][j] * p[j][c];
        for (int r = 0; r < 4; r++) trace += next[r][r];
        for (int r = 0; r < 4; r++) for (int c = 0; c < 4; c++) p[r][c] = next[r][c] / trace;
    }
    int best = 0; /* every column is the first eigenvector; the longest is the most exact */
    for (int c = 1; c < 4; c++) if (p[c][c] > p[best][best]) best = c;
    norm = sqrt(p[0][best] * p[0][best] + p[1][best] * p[1][best] + p[2][best] * p[2][best] + p[3][best] * p[3][best]);
    for (int r = 0; r < 4; r++) found->turn[r] = p[r][best] / norm;
    seeone_rotation(found->turn, R);
    found->scale = 0;
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) found->scale += R[c][r] * s[r][c] / spread;
    if (pairs->scale > 0) found->scale = pairs->scale;
    return found->scale > 0 ? SeeoneStatus_OK : seeone_refuse(message, SeeoneStatus_INPUT, "the targets coincide");
}

SEEONE_ALIGNMENT("horn-c", "1", horn)
