#pragma once
#include <x86intrin.h>
#include <cstdio>
#include <cstdlib>
struct ProfBox { const char* name; unsigned long long t=0, n=0; };
struct ProfAll { ProfBox b[24]; int n=0; ~ProfAll(){ if(getenv("PROF")) for(int i=0;i<n;++i) fprintf(stderr,"%-24s n %8llu  cyc/n %9.0f  tot %.3e\n",b[i].name,b[i].n,b[i].n? (double)b[i].t/b[i].n:0.0,(double)b[i].t);} };
inline ProfAll prof_all;
inline ProfBox* prof_box(const char* s){ prof_all.b[prof_all.n].name=s; return &prof_all.b[prof_all.n++]; }
struct ProfScope { ProfBox* b; unsigned long long s; ProfScope(ProfBox* x):b(x),s(__rdtsc()){} ~ProfScope(){ b->t+=__rdtsc()-s; ++b->n; } };
#define PROF(name) static ProfBox* pb_##name = prof_box(#name); ProfScope ps_##name(pb_##name)
