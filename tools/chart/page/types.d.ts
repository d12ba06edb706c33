/** What the page's scripts find beside them, for the checker of their types. */
declare const echarts: any;
