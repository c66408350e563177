"""A vehicle at work in 3-D: live or from a log, in a page, a file to share, a picture or a movie.

`scene_model` says what stands where at a time, in plain arrays; `log_source` and the live source of
`uvms_bringup.ros` say what the vehicle does; `page`, `export` and `picture` draw it.
"""
