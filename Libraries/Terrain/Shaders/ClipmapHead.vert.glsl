#version 330 core
//DSPACE::Defines
#define DSPACE_POSTS
